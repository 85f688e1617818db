#pragma once

#include <isolux/core/run.h>
#include <isolux/sample_sites/site_sampler.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace isolux {

/// Makes the sites of single texels when they are wanted: those that the sampler `texels` would make of all.
class TexelSiteMaker {
 public:
  /// \pre the volume outlives this
  TexelSiteMaker(const Volume& volume, const SiteRequest& request, const Run& run)
      : volume_(volume), request_(request), run_(run) {}

  /// Sites of those of the texels that can be lit, in the order given; `lit`, where it is not null, gets one flag a
  /// texel. Cost: some .2 microseconds a texel. \throw Cancelled
  [[nodiscard]] Sites make(std::span<const std::size_t> texels, std::vector<std::uint8_t>* lit = nullptr) const;

 private:
  const Volume& volume_;
  SiteRequest request_;
  const Run& run_;
};

}  // namespace isolux
