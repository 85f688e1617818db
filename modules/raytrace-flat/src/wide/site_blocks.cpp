#include "wide/site_blocks.h"

#include <isolux/core/error.h>
#include <isolux/core/parallel.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "wide/inner.h"
#include "wide/level_rank.h"
#include "wide/occupancy.h"

namespace isolux::wide {
namespace {

/// Sites that are gathered and sorted at once, in buckets next to each other: few, to save memory, and such a part of
/// all that passes over them are few.
constexpr std::size_t kSitesAGroup = std::size_t(1) << 17;
constexpr std::size_t kMostGroups = 16;
/// Buckets whose cell codes are made at once.
constexpr std::size_t kBucketsACode = CellCodes::kMaxThresholds;
/// Whose inner cubes are told by a byte.
constexpr std::size_t kMostBuckets = 255;
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

/// The sites that are wanted.
class Wanted {
 public:
  Wanted(const Sites& sites, const BlockRequest& request) : sites_(sites), only_(request.only), outer_(request.outer) {}

  [[nodiscard]] std::size_t size() const { return only_.empty() ? sites_.size() : only_.size(); }
  [[nodiscard]] std::size_t number(std::size_t i) const { return only_.empty() ? i : only_[i]; }
  [[nodiscard]] float level(std::size_t i) const { return signed_isovalue(sites_.isovalues[number(i)], outer_); }
  [[nodiscard]] const Vec3f& position(std::size_t i) const { return sites_.positions[number(i)]; }

 private:
  const Sites& sites_;
  std::span<const std::uint32_t> only_;
  OuterSide outer_;
};

/// The part of the volume whose values lie between the sites' least and largest isovalue.
double share_of_values(const Volume& volume, const Wanted& sites, OuterSide outer) {
  constexpr std::size_t kSample = 65536;
  ValueRange levels{.low = sites.level(0), .high = sites.level(0)};
  for (std::size_t i = 1; i < sites.size(); ++i)
    levels = {.low = std::min(levels.low, sites.level(i)), .high = std::max(levels.high, sites.level(i))};
  const std::span<const float> values = volume.values.values();
  // An odd step meets all columns of a volume whose rows are a power of two.
  const std::size_t step = std::max<std::size_t>(1, values.size() / kSample) | 1;
  std::size_t within = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < values.size(); i += step, ++count)
    within += std::size_t(signed_isovalue(values[i], outer) >= levels.low &&
                          signed_isovalue(values[i], outer) <= levels.high);
  return double(within) / double(count);
}

/// How many buckets pay. A ray costs the more the wider its bucket, by some 3500 ns for all isovalues in one, and a
/// bucket's occupancy some 40 ns a brick: with b buckets for a share s of all values, rays * 3500 * s / b + bricks * 40
/// * b is least at this root.
std::size_t bucket_count(const Volume& volume, const Wanted& sites, const BlockRequest& request) {
  constexpr double kWideOverBrick = 90.0;
  const double bricks = double(volume.lattice().count()) / 64.0;
  const double rays = double(sites.size()) * double(request.rays_per_site);
  const double pays = std::sqrt(kWideOverBrick * share_of_values(volume, sites, request.outer) * rays / bricks);
  return std::size_t(std::clamp(pays, 1.0, double(kMostBuckets)));
}

/// Whether finding cubes of inner values costs less than proofs save: some 9 ns a cube and 50 ns a ray.
bool has_proofs(const Volume& volume, const Wanted& sites, const BlockRequest& request) {
  constexpr double kRaysACube = 0.2;
  const double cubes = double(volume.lattice().count()) / 8.0;
  return request.proofs && double(sites.size()) * double(request.rays_per_site) >= kRaysACube * cubes;
}

/// Rising thresholds that share the sites out evenly; the first is below all of them.
std::vector<float> choose_thresholds(const Wanted& sites, std::size_t buckets) {
  const std::size_t enough = std::max<std::size_t>(256 * buckets, 4096);
  const std::size_t step = std::max<std::size_t>(1, sites.size() / enough);
  std::vector<float> sample;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const float value = sites.level(i);
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

  BucketLevels(const Volume& volume, const Wanted& sites, const BlockRequest& request)
      : least(choose_thresholds(sites, bucket_count(volume, sites, request))) {
    // Positions found by tracing are off their level set by a rounding, which must not cost them their bucket; and
    // whether a value is beyond an isovalue is to be no matter of rounding.
    const ValueRange range = request.values ? *request.values : value_range(volume);
    const float margin = 1e-4f * (range.high - range.low);
    const float rounding = 0x1p-20f * std::max(std::abs(range.low), std::abs(range.high));
    for (const float value : least) thresholds.push_back(value - margin);
    float most = least.front();
    for (std::size_t i = 0; i < sites.size(); ++i) most = std::max(most, sites.level(i));
    for (std::size_t b = 0; b < least.size(); ++b) {
      highest.push_back((b + 1 < least.size() ? least[b + 1] : most) + margin);
      ceilings.push_back(highest.back() + margin + rounding);
    }
  }
};

/// A site's place along Morton's curve, and below it its number.
using Entry = std::uint64_t;
constexpr int kNumberBits = 32;

std::uint32_t number_of(Entry entry) { return std::uint32_t(entry); }

/// The sites in buckets of isovalues, of which some are listed at a time.
class SiteBuckets {
 public:
  /// `least`: of each bucket's signed isovalues; none is below the first.
  SiteBuckets(const Wanted& sites, const std::vector<float>& least, const Index3& size, const Run& run)
      : sites_(sites),
        least_(least),
        rank_(least),
        most_(std::max(kSitesAGroup, sites.size() / kMostGroups)),
        counts_(block_count(sites.size(), kSitesAPass) * least.size()) {
    // Whole bricks would do; large volumes keep what a number leaves of the place.
    const int bits = 3 * int(std::bit_width(unsigned(std::max({size.x, size.y, size.z}))));
    coarser_ = std::max(kPlaceBits, bits - kNumberBits);
    parallel_blocks(sites.size(), kSitesAPass, run, "", [&](const Block& block) {
      std::uint32_t* const counts = &counts_[block.index * least_.size()];
      for (std::size_t i = block.begin; i < block.end; ++i) {
        const float value = sites_.level(i);
        if (value >= least_.front() && value < kBeyondAll) ++counts[rank_.reached(value) - 1];
      }
    });
  }

  [[nodiscard]] bool has_listed(std::size_t bucket) const { return bucket >= first_ && bucket < last_; }
  /// Lists those of the buckets from `first` on, a few or some sites, each bucket in Morton order.
  void list(std::size_t first, const Run& run) {
    first_ = first;
    last_ = group_end();
    std::vector<std::size_t> next = place_parts();
    const float low = least_[first_];
    const float high = last_ < least_.size() ? least_[last_] : kBeyondAll;
    parallel_blocks(sites_.size(), kSitesAPass, run, "", [&](const Block& block) {
      std::size_t* const places = &next[block.index * (last_ - first_)];
      for (std::size_t i = block.begin; i < block.end; ++i) {
        const float value = sites_.level(i);
        if (!(value >= low && value < high)) continue;
        entries_[places[rank_.reached(value) - 1 - first_]++] =
            morton(sites_.position(i)) >> coarser_ << kNumberBits | sites_.number(i);
      }
    });
    parallel_blocks(last_ - first_, 1, run, "", [&](const Block& block) {
      std::sort(entries_.begin() + std::ptrdiff_t(bucket_begins_[block.index]),
                entries_.begin() + std::ptrdiff_t(bucket_begins_[block.index + 1]));
    });
  }

  /// Those of a bucket that is listed.
  [[nodiscard]] std::span<const Entry> at(std::size_t bucket) const {
    const std::size_t begin = bucket_begins_[bucket - first_];
    return std::span(entries_).subspan(begin, bucket_begins_[bucket - first_ + 1] - begin);
  }

 private:
  /// At least one bucket, and more while their sites are no more than go into a group.
  [[nodiscard]] std::size_t group_end() const {
    std::size_t last = first_;
    for (std::size_t count = 0; last < least_.size(); ++last) {
      for (std::size_t at = last; at < counts_.size(); at += least_.size()) count += counts_[at];
      if (last > first_ && count > most_) break;
    }
    return last;
  }

  static constexpr int kPlaceBits = 7;  ///< of Morton's curve that do not matter
  static constexpr float kBeyondAll = std::numeric_limits<float>::infinity();

  /// Where each part of the sites puts those of each bucket of the group.
  [[nodiscard]] std::vector<std::size_t> place_parts() {
    const std::size_t parts = counts_.size() / least_.size();
    std::vector<std::size_t> begins(parts * (last_ - first_));
    bucket_begins_.assign(1, 0);
    std::size_t next = 0;
    for (std::size_t bucket = first_; bucket < last_; ++bucket) {
      for (std::size_t part = 0; part < parts; ++part) {
        begins[part * (last_ - first_) + bucket - first_] = next;
        next += counts_[part * least_.size() + bucket];
      }
      bucket_begins_.push_back(next);
    }
    entries_.resize(next);
    return begins;
  }

  const Wanted& sites_;
  const std::vector<float>& least_;
  LevelRank rank_;
  std::size_t most_;                   ///< sites of a group of several buckets
  std::vector<std::uint32_t> counts_;  ///< of each part of the sites, by bucket
  int coarser_ = kPlaceBits;
  std::size_t first_ = 0;  ///< of the buckets that are listed
  std::size_t last_ = 0;
  std::vector<std::size_t> bucket_begins_;
  std::vector<Entry> entries_;
};

}  // namespace

void for_each_block(const Volume& volume, const Sites& sites, const BlockRequest& request, const Run& run,
                    std::string_view stage, const std::function<void(const SiteBlock&)>& body) {
  const Lattice& lattice = volume.lattice();
  if (lattice.count() > std::size_t(std::numeric_limits<std::int32_t>::max()))
    throw InvalidInput(volume.name + ": the wide tracer takes volumes of at most 2^31 - 1 voxels");
  if (sites.size() > std::size_t(std::numeric_limits<std::uint32_t>::max()))
    throw InvalidInput(volume.name + ": the wide tracer takes at most 2^32 - 1 sites");
  const Wanted wanted(sites, request);
  if (wanted.size() == 0) return;
  const FieldView field{volume.values.values().data(), lattice.size, request.outer};
  const BucketLevels levels(volume, wanted, request);
  CellCodes codes(field);
  std::optional<InnerCodes> inner_codes;
  std::optional<InnerCubes> inner;
  if (has_proofs(volume, wanted, request)) inner.emplace(inner_codes.emplace(field, levels.ceilings, run));
  Occupancy occupancy(codes);
  SiteBuckets buckets(wanted, levels.least, lattice.size, run);
  std::size_t done = 0;
  for (std::size_t bucket = 0; bucket < levels.least.size(); ++bucket) {
    if (bucket % kBucketsACode == 0) {
      const std::size_t count = std::min(kBucketsACode, levels.least.size() - bucket);
      codes.build(std::span(levels.thresholds).subspan(bucket, count), run);
    }
    if (!buckets.has_listed(bucket)) buckets.list(bucket, run);
    const std::span<const Entry> entries = buckets.at(bucket);
    if (entries.empty()) continue;
    occupancy.build(codes, int(bucket % kBucketsACode), run);
    if (inner) inner->build(*inner_codes, int(bucket), run);
    const auto all = double(wanted.size());
    const Run part = part_of(run, double(done) / all, double(done + entries.size()) / all);
    parallel_blocks(entries.size(), request.sites_per_block, part, stage, [&](const Block& block) {
      std::vector<std::uint32_t> numbers;
      for (std::size_t i = block.begin; i < block.end; ++i) numbers.push_back(number_of(entries[i]));
      SiteBlock sites_of_block{numbers, field, occupancy.view(), inner ? inner->view() : InnerView{}};
      sites_of_block.occupancy.threshold = signed_isovalue(levels.thresholds[bucket], request.outer);
      sites_of_block.inner.ceiling = levels.highest[bucket];
      body(sites_of_block);
    });
    done += entries.size();
  }
}

}  // namespace isolux::wide
