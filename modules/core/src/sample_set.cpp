#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/sample_set.h>

#include <cmath>

namespace isolux {

void require_equal_lengths(const Sites& sites) {
  if (sites.isovalues.size() == sites.size() && sites.normals.size() == sites.size()) return;
  throw InvalidInput(fmt::format("{} site positions with {} isovalues and {} normals; there must be one of each",
                                 sites.size(), sites.isovalues.size(), sites.normals.size()));
}

void require_usable(const Sites& sites, const Lattice& volume, std::string_view whose) {
  require_equal_lengths(sites);
  const Vec3f last(volume.size - 1);
  const auto within = [](float place, float end) { return place >= 0.0f && place <= end; };  // false of NaN
  const auto is_number = [](const Vec3f& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Vec3f& p = sites.positions[i];
    const Vec3f& n = sites.normals[i];
    const auto refuse = [&](const std::string& why) {
      throw InvalidInput(fmt::format("{}: site {} at ({}, {}, {}) {}", whose, i, p.x, p.y, p.z, why));
    };
    if (!within(p.x, last.x) || !within(p.y, last.y) || !within(p.z, last.z))
      refuse(fmt::format("is not in the box, (0, 0, 0) to ({}, {}, {})", last.x, last.y, last.z));
    if (!std::isfinite(sites.isovalues[i]))
      refuse(fmt::format("has isovalue {}: it must be finite", sites.isovalues[i]));
    if (!is_number(n)) refuse(fmt::format("has normal ({}, {}, {}): it must be finite", n.x, n.y, n.z));
  }
}

Sites some_of(const Sites& sites, std::span<const std::size_t> numbers) {
  require_equal_lengths(sites);
  Sites some;
  for (const std::size_t i : numbers) {
    if (i >= sites.size()) throw InvalidInput(fmt::format("site {} of {}: there is none", i, sites.size()));
    some.positions.push_back(sites.positions[i]);
    some.isovalues.push_back(sites.isovalues[i]);
    some.normals.push_back(sites.normals[i]);
  }
  return some;
}

}  // namespace isolux
