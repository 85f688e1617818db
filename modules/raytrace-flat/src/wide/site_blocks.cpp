#include "wide/site_blocks.h"

#include <isolux/core/error.h>
#include <isolux/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "wide/inner.h"
#include "wide/occupancy.h"

namespace isolux::wide {
namespace {

/// Buckets whose sites are gathered and sorted at once: few, to save memory; several, to save passes over the sites.
constexpr std::size_t kBucketsAGroup = 4;
constexpr std::size_t kSitesAPass = 65536;

/// Bits of a cell index spread to every third place (for the Morton order).
std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0x1FFFFF;
  x = (x | x << 32) & 0x001F00000000FFFF;
  x = (x | x << 16) & 0x001F0000FF0000FF;
  x = (x | x << 8) & 0x100F00F00F00F00F;
  x = (x | x << 4) & 0x10C30C30C30C30C3;
  return (x | x << 2) & 0x1249249249249249;
}

std::uint64_t morton(const Vec3f& position) {
  return spread_bits(std::uint64_t(position.x)) | spread_bits(std::uint64_t(position.y)) << 1 |
         spread_bits(std::uint64_t(position.z)) << 2;
}

/// Isovalues with the sign that makes the inner side the higher one.
float signed_isovalue(float isovalue, OuterSide outer) { return outer == OuterSide::kLower ? isovalue : -isovalue; }

/// The part of the volume whose values lie between the sites' least and largest isovalue.
double share_of_values(const Volume& volume, const Sites& sites) {
  constexpr std::size_t kSample = 65536;
  const auto [low, high] = std::minmax_element(sites.isovalues.begin(), sites.isovalues.end());
  const std::span<const float> values = volume.values.values();
  // An odd step meets all columns of a volume whose rows are a power of two.
  const std::size_t step = std::max<std::size_t>(1, values.size() / kSample) | 1;
  std::size_t within = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < values.size(); i += step, ++count)
    within += std::size_t(values[i] >= *low && values[i] <= *high);
  return double(within) / double(count);
}

/// How many buckets pay. A ray costs the more the wider its bucket, by some 3500 ns for all isovalues in one, and a
/// bucket's occupancy some 40 ns a brick: with b buckets for a share s of all values, rays * 3500 * s / b + bricks * 40
/// * b is least at this root.
std::size_t bucket_count(const Volume& volume, const Sites& sites, const BlockRequest& request) {
  constexpr double kWideOverBrick = 90.0;
  const double bricks = double(volume.lattice().count()) / 64.0;
  const double rays = double(sites.size()) * double(request.rays_per_site);
  const double pays = std::sqrt(kWideOverBrick * share_of_values(volume, sites) * rays / bricks);
  return std::size_t(std::clamp(pays, 1.0, double(CellCodes::kMaxThresholds)));
}

/// Rising thresholds that share the sites out evenly; the first is below all of them.
std::vector<float> choose_thresholds(const Sites& sites, OuterSide outer, std::size_t buckets) {
  constexpr std::size_t kSample = 65536;
  const std::size_t step = std::max<std::size_t>(1, sites.size() / kSample);
  std::vector<float> sample;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const float value = signed_isovalue(sites.isovalues[i], outer);
    least = std::min(least, value);
    if (i % step == 0) sample.push_back(value);
  }
  std::sort(sample.begin(), sample.end());
  std::vector<float> thresholds{least};
  for (std::size_t b = 1; b < buckets; ++b) {
    const float value = sample[b * sample.size() / buckets];
    if (value > thresholds.back()) thresholds.push_back(value);
  }
  return thresholds;
}

/// The isovalues of the buckets, with the sign that makes the inner side the higher one.
struct BucketLevels {
  std::vector<float> least;       ///< of each bucket's sites
  std::vector<float> thresholds;  ///< a little lower
  std::vector<float> highest;     ///< a little higher than any of the bucket
  std::vector<float> ceilings;    ///< higher than that by more than a rounding

  BucketLevels(const Volume& volume, const Sites& sites, const BlockRequest& request)
      : least(choose_thresholds(sites, request.outer, bucket_count(volume, sites, request))) {
    // Positions found by tracing are off their level set by a rounding, which must not cost them their bucket; and
    // whether a value is beyond an isovalue is to be no matter of rounding.
    const ValueRange range = value_range(volume);
    const float margin = 1e-4f * (range.high - range.low);
    const float rounding = 0x1p-20f * std::max(std::abs(range.low), std::abs(range.high));
    for (const float value : least) thresholds.push_back(value - margin);
    float most = least.front();
    for (const float isovalue : sites.isovalues) most = std::max(most, signed_isovalue(isovalue, request.outer));
    for (std::size_t b = 0; b < least.size(); ++b) {
      highest.push_back((b + 1 < least.size() ? least[b + 1] : most) + margin);
      ceilings.push_back(highest.back() + margin + rounding);
    }
  }
};

struct Entry {
  std::uint64_t place;  ///< along Morton's curve
  std::uint32_t site;
  bool operator<(const Entry& other) const { return place != other.place ? place < other.place : site < other.site; }
};
using Bucket = std::vector<Entry>;

/// The sites of the buckets from `first` on, as many as a group has, each bucket in Morton order.
std::vector<Bucket> collect(const Sites& sites, OuterSide outer, const std::vector<float>& thresholds,
                            std::size_t first, const Run& run) {
  const std::size_t last = std::min(thresholds.size(), first + kBucketsAGroup);
  std::vector<std::array<Bucket, kBucketsAGroup>> parts(block_count(sites.size(), kSitesAPass));
  const float low = thresholds[first];
  const float high = last < thresholds.size() ? thresholds[last] : std::numeric_limits<float>::infinity();
  parallel_blocks(sites.size(), kSitesAPass, run, "", [&](const Block& block) {
    auto& part = parts[block.index];
    for (std::size_t i = block.begin; i < block.end; ++i) {
      const float value = signed_isovalue(sites.isovalues[i], outer);
      if (!(value >= low && value < high)) continue;
      std::size_t bucket = 0;
      while (first + bucket + 1 < last && value >= thresholds[first + bucket + 1]) ++bucket;
      part[bucket].push_back({morton(sites.positions[i]) >> 7, std::uint32_t(i)});
    }
  });
  std::vector<Bucket> buckets(last - first);
  parallel_blocks(buckets.size(), 1, run, "", [&](const Block& block) {
    Bucket& bucket = buckets[block.index];
    for (auto& part : parts) {
      const Bucket found = std::exchange(part[block.index], {});
      bucket.insert(bucket.end(), found.begin(), found.end());
    }
    std::sort(bucket.begin(), bucket.end());
  });
  return buckets;
}

}  // namespace

void for_each_block(const Volume& volume, const Sites& sites, const BlockRequest& request, const Run& run,
                    std::string_view stage, const std::function<void(const SiteBlock&)>& body) {
  const Lattice& lattice = volume.lattice();
  if (lattice.count() > std::size_t(std::numeric_limits<std::int32_t>::max()) ||
      sites.size() > std::size_t(std::numeric_limits<std::uint32_t>::max()))
    throw InvalidInput(volume.name + ": the wide tracer takes volumes of at most 2^31 - 1 voxels");
  if (sites.size() == 0) return;
  const FieldView field{volume.values.values().data(), lattice.size, request.outer};
  const BucketLevels levels(volume, sites, request);
  const CellCodes codes(field, levels.thresholds, run);
  const InnerCodes inner_codes(field, levels.ceilings, run);
  Occupancy occupancy(codes);
  InnerCubes inner(inner_codes);
  std::size_t done = 0;
  for (std::size_t first = 0; first < levels.least.size(); first += kBucketsAGroup) {
    const std::vector<Bucket> group = collect(sites, request.outer, levels.least, first, run);
    for (std::size_t b = 0; b < group.size(); ++b) {
      const Bucket& entries = group[b];
      if (entries.empty()) continue;
      const std::size_t bucket = first + b;
      occupancy.build(codes, int(bucket), run);
      inner.build(inner_codes, int(bucket), run);
      const auto all = double(sites.size());
      const Run part = part_of(run, double(done) / all, double(done + entries.size()) / all);
      parallel_blocks(entries.size(), request.sites_per_block, part, stage, [&](const Block& block) {
        std::vector<std::uint32_t> numbers;
        for (std::size_t i = block.begin; i < block.end; ++i) numbers.push_back(entries[i].site);
        SiteBlock sites_of_block{numbers, field, occupancy.view(), inner.view()};
        sites_of_block.occupancy.threshold = signed_isovalue(levels.thresholds[bucket], request.outer);
        sites_of_block.inner.ceiling = levels.highest[bucket];
        body(sites_of_block);
      });
      done += entries.size();
    }
  }
}

}  // namespace isolux::wide
