#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "wide/rays.h"

namespace isolux::wide {

/// Sites of similar isovalue that lie close together, and what rays of their isovalues need.
struct SiteBlock {
  std::span<const std::uint32_t> sites;  ///< numbers into the Sites
  FieldView field;
  OccupancyView occupancy;
  InnerView inner;  ///< knows nothing where it is not wanted or the rays are few

  /// The isovalue nearest to `wanted` for which the occupancy holds: positions found by tracing are rounded, and so is
  /// their isovalue, which may drift past the threshold by as much.
  [[nodiscard]] float admitted(float wanted) const {
    return field.outer == OuterSide::kLower ? std::max(wanted, occupancy.threshold)
                                            : std::min(wanted, occupancy.threshold);
  }
};

struct BlockRequest {
  OuterSide outer = OuterSide::kLower;
  std::size_t rays_per_site = 64;         ///< expected; decides how finely isovalues are told apart
  std::size_t sites_per_block = 128;      ///< at most
  bool proofs = true;                     ///< SiteBlock::inner is wanted, where it pays
  std::optional<ValueRange> values{};     ///< of the volume, where known: saves a pass
  std::span<const std::uint32_t> only{};  ///< numbers of the sites that are wanted, each once; empty: all
};

/// Calls body for blocks that hold every site that is wanted once, on run.threads threads. Sites are taken bucket by
/// bucket of isovalues (equal shares of the sites, up to 255 of them), within a bucket in Morton order, so that
/// neighbours in time are neighbours in memory. Neither the blocks nor their order in memory depend on the number of
/// threads. Memory: half a byte a cell, 16 bytes a brick of 4^3 cells, 9 bits a cube of 2^3, and 8 bytes for each site
/// that is listed: a sixteenth of them, 131,072, or those of one bucket. \throw Cancelled
void for_each_block(const Volume& volume, const Sites& sites, const BlockRequest& request, const Run& run,
                    std::string_view stage, const std::function<void(const SiteBlock&)>& body);

}  // namespace isolux::wide
