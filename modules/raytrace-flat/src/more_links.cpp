// More rays and more sites for links that are there.
#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/raytrace_flat/light_links.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "link_solver.h"
#include "wide/net_mean.h"

namespace isolux {
namespace {

/// \throw InvalidInput unless each is a site's, once
void require_numbers(std::span<const std::uint32_t> numbers, std::size_t sites) {
  std::vector<bool> seen(sites, false);
  for (const std::uint32_t number : numbers) {
    if (number >= sites) throw InvalidInput(fmt::format("site {}: the links have {} sites", number, sites));
    if (seen[number]) throw InvalidInput(fmt::format("site {} is listed twice", number));
    seen[number] = true;
  }
}

}  // namespace

struct LightLinks::Mark {
  std::size_t sites;
  std::size_t rounds;
  std::size_t probes;
  TraceCounters counters;
  std::vector<std::uint32_t> rays;
};

LightLinks::Mark LightLinks::mark() const {
  return {.sites = sites_.size(),
          .rounds = rounds_->all.size(),
          .probes = probes_.size(),
          .counters = counters_,
          .rays = rays_};
}

void LightLinks::go_back(Mark&& before) noexcept {
  sites_.positions.resize(before.sites);
  sites_.isovalues.resize(before.sites);
  sites_.normals.resize(before.sites);
  rounds_->all.resize(before.rounds);
  probes_.resize(before.probes);
  counters_ = before.counters;
  rays_ = std::move(before.rays);
}

void LightLinks::require_open(const char* what) const {
  if (settings_.nets == RayNets::kInterleaved)
    throw InvalidInput(fmt::format("links of interleaved nets take no more {}", what));
  if (settings_.kept != 0) throw InvalidInput(fmt::format("links of which a part is kept take no more {}", what));
}

void LightLinks::extend(std::span<const std::uint32_t> sites, const Run& run) {
  require_open("rays");
  require_numbers(sites, sites_.size());
  std::map<std::uint32_t, std::vector<std::uint32_t>> by_rays;
  for (const std::uint32_t site : sites) by_rays[rays_[site]].push_back(site);
  Mark before = mark();
  try {
    for (const auto& [rays, numbers] : by_rays) {
      trace(rays, rays, numbers, run);
      for (const std::uint32_t site : numbers) rays_[site] *= 2;
    }
    if (again_ == nullptr) return;
    std::vector<std::uint32_t> doubled;
    for (std::size_t p = 0; p < probes_.size(); ++p)
      if (again_->rays_[p] != rays_[probes_[p]]) doubled.push_back(std::uint32_t(p));
    change_again(run, [&](const Run& quiet) { again_->extend(doubled, quiet); });
  } catch (...) {
    go_back(std::move(before));
    throw;
  }
}

void LightLinks::append(const Sites& more, const Run& run) {
  if (settings_.ends == LinkEnds::kKept)
    throw InvalidInput("links that know the sites at the texels take no more sites");
  require_open("sites");
  require_equal_lengths(more);
  if (more.size() == 0) return;
  // `more` may be the links' own sites, which grow here.
  const std::size_t count = more.size();
  const std::vector<std::size_t> probes = again_ != nullptr ? wide::choose_probes(more) : std::vector<std::size_t>{};
  const Sites probed = some_of(more, probes);
  Mark before = mark();
  try {
    const auto grow = [&](auto& array, const auto& by) {
      array.resize(before.sites + count);
      std::copy_n(by.begin(), count, array.begin() + std::ptrdiff_t(before.sites));
    };
    grow(sites_.positions, more.positions);
    grow(sites_.isovalues, more.isovalues);
    grow(sites_.normals, more.normals);
    rays_.resize(sites_.size(), std::uint32_t(settings_.rays));
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), std::uint32_t(before.sites));
    trace(0, std::size_t(settings_.rays), numbers, run);
    if (again_ == nullptr) return;
    for (const std::size_t probe : probes) probes_.push_back(before.sites + probe);
    change_again(run, [&](const Run& quiet) { again_->append(probed, quiet); });
  } catch (...) {
    go_back(std::move(before));
    throw;
  }
}

void LightLinks::change_again(const Run& run, const std::function<void(const Run& quiet)>& change) {
  Run quiet = run;
  quiet.progress = {};
  const TraceCounters before = again_->counters_;
  change(quiet);
  add(counters_, again_->counters_ - before);
}

}  // namespace isolux
