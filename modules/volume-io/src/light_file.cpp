#include "nrrd_header.h"
#include "nrrd_write.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/options.h>
#include <isolux/volume_io/atomic_file.h>
#include <isolux/volume_io/light_file.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace isolux {
namespace {

/// "step mean r g b" of each term, with semicolons between.
std::string near_field_text(const std::vector<NearFieldTerm>& terms) {
  std::string text;
  for (const auto& t : terms) {
    text +=
        fmt::format("{}{} {} {} {} {}", text.empty() ? "" : "; ", t.step, t.mean, t.weight.x, t.weight.y, t.weight.z);
  }
  return text;
}

std::vector<NearFieldTerm> parse_near_field(const std::string& path, const std::string& text) {
  std::vector<NearFieldTerm> terms;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ';');) {
    std::istringstream numbers(part);
    NearFieldTerm t;
    if (!(numbers >> t.step >> t.mean >> t.weight.x >> t.weight.y >> t.weight.z)) {
      throw InvalidInput(fmt::format("{}: isolux.near_field '{}'; terms of five numbers are wanted", path, text));
    }
    terms.push_back(t);
  }
  return terms;
}

/// "LOW:HIGH"
ValueRange parse_isovalues(const std::string& path, const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) {
    throw InvalidInput(fmt::format("{}: isolux.iso_range '{}'; LOW:HIGH is wanted", path, text));
  }
  const std::string what = path + ": isolux.iso_range";
  return {.low = float(parse_number(what, text.substr(0, colon))),
          .high = float(parse_number(what, text.substr(colon + 1)))};
}

/// Of each texel the values of its channels, then their slopes.
std::vector<float> interleave(const IlluminationGrid& grid) {
  const auto channels = std::size_t(grid.channels);
  std::vector<float> both;
  both.reserve(2 * grid.values.size());
  for (std::size_t at = 0; at < grid.values.size(); at += channels) {
    both.insert(both.end(), &grid.values[at], &grid.values[at] + channels);
    both.insert(both.end(), &grid.detail.slopes[at], &grid.detail.slopes[at] + channels);
  }
  return both;
}

void take_apart(const std::vector<float>& both, IlluminationGrid& grid) {
  const auto channels = std::size_t(grid.channels);
  for (std::size_t at = 0; at < both.size(); at += 2 * channels) {
    grid.values.insert(grid.values.end(), &both[at], &both[at] + channels);
    grid.detail.slopes.insert(grid.detail.slopes.end(), &both[at] + channels, &both[at] + 2 * channels);
  }
}

}  // namespace

void write_light(const LightFile& light, const std::string& path, const std::string& space,
                 const LightWriteOptions& options) {
  const LightDetail& extra = light.grid.detail;
  const bool sloped = !extra.slopes.empty();
  detail::NrrdImage image{.type = ScalarType::kFloat32,
                          .channels = light.grid.channels * (sloped ? 2 : 1),
                          .lattice = light.grid.lattice,
                          .space = space,
                          .key_values = light.metadata,
                          .compress = options.compress,
                          .data_file = {}};
  if (!extra.near_field.empty()) image.key_values["isolux.near_field"] = near_field_text(extra.near_field);
  if (!extra.empty()) image.key_values["isolux.light_ceiling"] = fmt::format("{}", extra.ceiling);
  write_atomically(path, [&](std::ostream& out) {
    detail::write_nrrd_header(out, image);
    detail::write_nrrd_values(out, image, sloped ? interleave(light.grid) : light.grid.values);
  });
}

LightFile read_light(const std::string& path) {
  detail::NrrdHeader header = detail::read_nrrd_header(path, {});
  const std::size_t axes = header.axes.size();
  const auto first = axes == 4 ? header.axes.front().size : 1;
  const bool sloped = first == 2 || first == 6;
  if ((axes != 3 && axes != 4) || (axes == 4 && first != 3 && !sloped)) {
    throw InvalidInput(fmt::format("{}: a light file has 3 axes, or 4 with the first of size 2, 3 or 6; this has {}",
                                   path, axes == 4 ? fmt::format("4 with {}", first) : std::to_string(axes)));
  }
  LightFile light;
  light.grid.channels = first == 3 || first == 6 ? 3 : 1;
  light.grid.lattice = detail::nrrd_frame(header, std::span(header.axes).last(3)).lattice;
  std::vector<float> values = detail::read_nrrd_values(header, {});
  if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }))
    throw InvalidInput(fmt::format("{}: a light file's values are finite; this has others", path));
  if (sloped) {
    take_apart(values, light.grid);
  } else {
    light.grid.values = std::move(values);
  }
  light.metadata = std::move(header.key_values);
  if (const auto it = light.metadata.find("isolux.near_field"); it != light.metadata.end()) {
    light.grid.detail.near_field = parse_near_field(path, it->second);
  }
  if (const auto it = light.metadata.find("isolux.light_ceiling"); it != light.metadata.end()) {
    light.grid.detail.ceiling = float(parse_number(path + ": isolux.light_ceiling", it->second));
  }
  if (const auto it = light.metadata.find("isolux.iso_range"); it != light.metadata.end()) {
    light.grid.detail.isovalues = parse_isovalues(path, it->second);
  }
  return light;
}

}  // namespace isolux
