#include "nrrd_header.h"
#include "nrrd_write.h"
#include "plain_text.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/options.h>
#include <isolux/volume_io/atomic_file.h>
#include <isolux/volume_io/light_file.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <utility>

namespace isolux {
namespace {

/// Sizes of a near-field term's step that mean anything, in grid spacings: what is found there is divided by it.
constexpr float kLeastStep = 1e-6f;
constexpr float kMostStep = 1e6f;

/// "step mean r g b" of each term, with semicolons between.
std::string near_field_text(const std::vector<NearFieldTerm>& terms) {
  std::string text;
  for (const auto& t : terms) {
    text +=
        fmt::format("{}{} {} {} {} {}", text.empty() ? "" : "; ", t.step, t.mean, t.weight.x, t.weight.y, t.weight.z);
  }
  return text;
}

std::vector<NearFieldTerm> parse_near_field(const std::string& path, const std::string& key, const std::string& text) {
  std::vector<NearFieldTerm> terms;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ';');) {
    std::istringstream numbers(part);
    numbers.imbue(std::locale::classic());  // whatever the program around has set
    NearFieldTerm t;
    if (!(numbers >> t.step >> t.mean >> t.weight.x >> t.weight.y >> t.weight.z)) {
      throw InvalidInput(
          fmt::format("{}: {} '{}'; terms of five numbers are wanted", path, key, detail::excerpt(text)));
    }
    if (const float size = std::fabs(t.step); !(size >= kLeastStep && size <= kMostStep)) {
      throw InvalidInput(fmt::format("{}: {} has a step of {} in '{}'; allowed are {:g} to {:g} and their negatives",
                                     path, key, t.step, detail::excerpt(text), kLeastStep, kMostStep));
    }
    terms.push_back(t);
  }
  return terms;
}

/// "LOW:HIGH", finite where the range is open.
std::string isovalues_text(const ValueRange& range) {
  constexpr float kMost = std::numeric_limits<float>::max();
  return fmt::format("{}:{}", std::max(range.low, -kMost), std::min(range.high, kMost));
}

ValueRange parse_isovalues(const std::string& path, const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) {
    throw InvalidInput(fmt::format("{}: isolux.iso_range '{}'; LOW:HIGH is wanted", path, text));
  }
  const std::string what = path + ": isolux.iso_range";
  const ValueRange range{.low = float(parse_number(what, text.substr(0, colon))),
                         .high = float(parse_number(what, text.substr(colon + 1)))};
  if (!(std::isfinite(range.low) && std::isfinite(range.high) && range.low <= range.high))
    throw InvalidInput(fmt::format("{} '{}': allowed are floats, LOW not above HIGH", what, text));
  return range;
}

/// A light's sides, the outer one first.
std::vector<const IlluminationGrid*> sides_of(const LightFile& light) {
  std::vector<const IlluminationGrid*> sides{&light.grid};
  if (light.inner) sides.push_back(&*light.inner);
  return sides;
}

/// What a side holds of each texel, in the file's order: each channel's values, slopes, and slopes along the normal's
/// x, y and z, as far as they are there. `Grid` is an IlluminationGrid or a constant one.
template <class Grid>
auto parts_of(Grid& side) {
  std::vector<decltype(&side.values)> parts{&side.values, &side.detail.slopes};
  for (auto& slopes : side.detail.normal_slopes) parts.push_back(&slopes);
  return parts;
}

/// Of each texel a side's numbers, then the next side's.
std::vector<float> interleave(const std::vector<const IlluminationGrid*>& sides) {
  const auto channels = std::size_t(sides.front()->channels);
  std::vector<float> all;
  all.reserve(sides.size() * sides.front()->values.size() * std::size_t(sides.front()->detail.numbers()));
  for (std::size_t at = 0; at < sides.front()->values.size(); at += channels) {
    for (const IlluminationGrid* side : sides)
      for (const std::vector<float>* part : parts_of(*side))
        if (!part->empty()) all.insert(all.end(), &(*part)[at], &(*part)[at] + channels);
  }
  return all;
}

/// What a texel's numbers are, beside its values.
struct TexelNumbers {
  bool sloped = false;
  bool turned = false;

  [[nodiscard]] std::size_t count() const { return 1 + (sloped ? 1 : 0) + (turned ? 3 : 0); }
};

/// The numbers of one side among `stride` a texel, from `first` on.
void take_side(const std::vector<float>& all, std::size_t first, std::size_t stride, const TexelNumbers& numbers,
               IlluminationGrid& grid) {
  const auto channels = std::size_t(grid.channels);
  const std::vector<std::vector<float>*> parts = parts_of(grid);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (p > 0 && !(p == 1 ? numbers.sloped : numbers.turned)) continue;
    parts[p]->reserve(all.size() / stride * channels);
    for (std::size_t at = first; at < all.size(); at += stride)
      parts[p]->insert(parts[p]->end(), &all[at], &all[at] + channels);
    first += channels;
  }
}

void require_like(const IlluminationGrid& outer, const IlluminationGrid& inner, const std::string& path) {
  if (inner.lattice.size == outer.lattice.size && inner.channels == outer.channels &&
      inner.values.size() == outer.values.size() && inner.detail.slopes.size() == outer.detail.slopes.size() &&
      inner.detail.normal_slopes[0].size() == outer.detail.normal_slopes[0].size())
    return;
  throw InvalidInput(
      fmt::format("{}: the light of the inner side is laid out differently than the outer side's", path));
}

/// isolux.near_field and so on; isolux.inner.near_field and so on.
std::string detail_key(LevelSetSide side, const char* name) {
  return fmt::format("isolux.{}{}", side == LevelSetSide::kInner ? "inner." : "", name);
}

using KeyValues = std::map<std::string, std::string>;

/// Whoever knows only the first kind must not add terms to texels of the second.
const char* near_field_name(TexelLight kind) { return kind == TexelLight::kReduced ? "near_field" : "own_near_field"; }

void write_detail(const LightDetail& extra, LevelSetSide side, KeyValues& pairs) {
  for (const TexelLight kind : {TexelLight::kReduced, TexelLight::kOwn})
    pairs.erase(detail_key(side, near_field_name(kind)));
  if (!extra.near_field.empty())
    pairs[detail_key(side, near_field_name(extra.texel_light))] = near_field_text(extra.near_field);
  if (!extra.empty() && std::isfinite(extra.ceiling))
    pairs[detail_key(side, "light_ceiling")] = fmt::format("{}", extra.ceiling);
  // What else says it in a file (make_light_file) also says it of light whose range is that of the whole volume.
  if (extra.isovalues) pairs["isolux.iso_range"] = isovalues_text(*extra.isovalues);
}

void read_detail(const std::string& path, const KeyValues& pairs, LevelSetSide side, LightDetail& extra) {
  for (const TexelLight kind : {TexelLight::kReduced, TexelLight::kOwn}) {
    const auto it = pairs.find(detail_key(side, near_field_name(kind)));
    if (it == pairs.end()) continue;
    extra.near_field = parse_near_field(path, it->first, it->second);
    extra.texel_light = kind;
  }
  if (const auto it = pairs.find(detail_key(side, "light_ceiling")); it != pairs.end()) {
    const double ceiling = parse_number(path + ": " + it->first, it->second);
    extra.ceiling = float(ceiling);
    if (!(ceiling >= 0.0 && std::isfinite(extra.ceiling)))
      throw InvalidInput(fmt::format("{}: {} = '{}': allowed are 0 to {:g}", path, it->first, it->second,
                                     double(std::numeric_limits<float>::max())));
  }
  if (const auto it = pairs.find("isolux.iso_range"); it != pairs.end()) {
    extra.isovalues = parse_isovalues(path, it->second);
  }
}

/// Whether isolux.sides says so.
bool has_both_sides(const std::string& path, const KeyValues& pairs) {
  const auto it = pairs.find("isolux.sides");
  if (it == pairs.end() || it->second == "outer") return false;
  if (it->second == "both") return true;
  throw InvalidInput(fmt::format("{}: isolux.sides '{}'; allowed are outer, both", path, it->second));
}

// What says that there are slopes along the normal, since four channels may be anything.
constexpr const char* kNumbersKey = "isolux.texel_numbers";
constexpr const char* kAllNumbers = "value slope normal";
constexpr const char* kWithoutSlope = "value normal";

/// The numbers of a light whose file may say what they are; `a_side` of all channels.
TexelNumbers texel_numbers(const std::string& path, const KeyValues& pairs, std::size_t a_side) {
  const auto it = pairs.find(kNumbersKey);
  if (it == pairs.end()) return {.sloped = a_side == 2 || a_side == 6, .turned = false};
  if (it->second == kAllNumbers) return {.sloped = true, .turned = true};
  if (it->second == kWithoutSlope) return {.sloped = false, .turned = true};
  throw InvalidInput(
      fmt::format("{}: {} '{}'; allowed are {}, {}", path, kNumbersKey, it->second, kAllNumbers, kWithoutSlope));
}

/// What the channel axis holds.
struct ChannelAxis {
  std::size_t numbers = 1;  ///< a texel
  std::size_t sides = 1;
  std::size_t channels = 1;  ///< a side
  TexelNumbers of_channel{};
};

/// \throw InvalidInput if no light has such axes
ChannelAxis channel_axis(const std::string& path, const detail::NrrdHeader& header) {
  const std::size_t axes = header.axes.size();
  ChannelAxis axis{.numbers = axes == 4 ? std::size_t(header.axes.front().size) : 1,
                   .sides = has_both_sides(path, header.key_values) ? 2U : 1U};
  const std::size_t a_side = axis.numbers / axis.sides;
  axis.of_channel = texel_numbers(path, header.key_values, a_side);
  const std::size_t count = axis.of_channel.count();
  axis.channels = a_side == 3 * count ? 3 : 1;
  const bool known = axis.numbers == axis.sides * axis.channels * count && (axis.numbers > 1 || axes == 3);
  if ((axes != 3 && axes != 4) || !known) {
    const std::size_t least = axis.sides * count;
    const std::string plain = axis.sides == 2 ? "2, 4, 6 or 12 for both sides" : "2, 3 or 6";
    throw InvalidInput(fmt::format("{}: a light file has 3 axes, or 4 with the first of size {}; this has {}", path,
                                   axis.of_channel.turned ? fmt::format("{} or {}", least, 3 * least) : plain,
                                   axes == 4 ? fmt::format("4 with {}", axis.numbers) : std::to_string(axes)));
  }
  return axis;
}

}  // namespace

const IlluminationGrid& light_of_side(const LightFile& light, LevelSetSide side, const std::string& path) {
  if (side == LevelSetSide::kOuter) return light.grid;
  if (light.inner) return *light.inner;
  throw InvalidInput(
      fmt::format("{}: it holds light of the outer side alone; a scene with \"sides\": \"both\" lights both", path));
}

void write_light(const LightFile& light, const std::string& path, const std::string& space,
                 const LightWriteOptions& options) {
  require_complete(light.grid);
  if (light.inner) {
    require_complete(*light.inner);
    require_like(light.grid, *light.inner, path);
  }
  const auto sides = sides_of(light);
  const int numbers = light.grid.detail.numbers();
  detail::NrrdImage image{.type = ScalarType::kFloat32,
                          .channels = light.grid.channels * numbers * int(sides.size()),
                          .lattice = light.grid.lattice,
                          .space = space,
                          .key_values = light.metadata,
                          .compress = options.compress,
                          .data_file = {}};
  write_detail(light.grid.detail, LevelSetSide::kOuter, image.key_values);
  image.key_values.erase("isolux.sides");
  image.key_values.erase(kNumbersKey);
  if (!light.grid.detail.normal_slopes[0].empty())
    image.key_values[kNumbersKey] = light.grid.detail.slopes.empty() ? kWithoutSlope : kAllNumbers;
  if (light.inner) {
    write_detail(light.inner->detail, LevelSetSide::kInner, image.key_values);
    image.key_values["isolux.sides"] = "both";
  }
  write_atomically(path, [&](std::ostream& out) {
    detail::write_nrrd_header(out, image);
    if (numbers > 1 || light.inner) {
      detail::write_nrrd_values(out, image, interleave(sides));
    } else {
      detail::write_nrrd_values(out, image, light.grid.values);
    }
  });
}

LightFile read_light(const std::string& path) {
  detail::NrrdHeader header = detail::read_nrrd_header(path, {});
  const ChannelAxis axis = channel_axis(path, header);
  LightFile light;
  light.path = path;
  light.grid.channels = int(axis.channels);
  light.grid.lattice = detail::nrrd_frame(header, std::span(header.axes).last(3)).lattice;
  auto values = std::get<std::vector<float>>(detail::read_nrrd_values(header, {}, {}, {}).list);
  if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }))
    throw InvalidInput(fmt::format("{}: a light file's values are finite; this has others", path));
  if (axis.sides == 2) light.inner = light.grid;
  if (axis.sides == 1 && axis.of_channel.count() == 1) {
    light.grid.values = std::move(values);
  } else {
    take_side(values, 0, axis.numbers, axis.of_channel, light.grid);
    if (light.inner) take_side(values, axis.numbers / 2, axis.numbers, axis.of_channel, *light.inner);
  }
  light.metadata = std::move(header.key_values);
  read_detail(path, light.metadata, LevelSetSide::kOuter, light.grid.detail);
  if (light.inner) read_detail(path, light.metadata, LevelSetSide::kInner, light.inner->detail);
  return light;
}

}  // namespace isolux
