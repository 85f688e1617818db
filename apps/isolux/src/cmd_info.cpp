#include <fmt/format.h>
#include <isolux/core/options.h>
#include <isolux/volume_io/read.h>
#include <isolux/volume_io/scalar_type.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <variant>

#include "commands.h"
#include "terminal.h"
#include "value_moments.h"
#include "volume_options.h"

namespace isolux {
namespace {

constexpr std::size_t kBins = 32;

struct Statistics {
  float low = std::numeric_limits<float>::infinity();
  float high = -std::numeric_limits<float>::infinity();
  ValueMoments moments;  ///< of the finite values
  std::size_t not_finite = 0;
  std::array<std::size_t, kBins> histogram{};  ///< of the finite values, equal bins from low to high
};

Statistics statistics(const auto& values) {
  Statistics s{.moments = value_moments(values)};
  for (const float v : values) {
    if (!std::isfinite(v)) {
      ++s.not_finite;
      continue;
    }
    s.low = std::min(s.low, v);
    s.high = std::max(s.high, v);
  }
  const double scale = s.high > s.low ? double(kBins) / (double(s.high) - double(s.low)) : 0.0;
  for (const float v : values) {
    if (std::isfinite(v)) ++s.histogram[std::min(kBins - 1, std::size_t((double(v) - double(s.low)) * scale))];
  }
  return s;
}

nlohmann::json to_json(const StoredVolume& volume, const Statistics& s) {
  const Lattice& lattice = volume.lattice();
  const Vec3 spacing = lattice.frame.spacing();
  const Vec3& o = lattice.frame.origin;
  nlohmann::json axes = nlohmann::json::array();
  for (int a = 0; a < 3; ++a)
    axes.push_back({lattice.frame.axes[a].x, lattice.frame.axes[a].y, lattice.frame.axes[a].z});
  nlohmann::json json{{"name", volume.name},
                      {"dims", {lattice.size.x, lattice.size.y, lattice.size.z}},
                      {"type", scalar_type_name(volume.stored_type)},
                      {"spacing", {spacing.x, spacing.y, spacing.z}},
                      {"origin", {o.x, o.y, o.z}},
                      {"space", volume.space},
                      {"space_directions", axes},
                      {"voxels", lattice.count()},
                      {"not_finite", s.not_finite},
                      {"sha256", volume_sha256(volume)}};
  if (s.moments.count > 0) {
    json["range"] = {s.low, s.high};
    json["mean"] = s.moments.mean;
    json["standard_deviation"] = s.moments.standard_deviation;
    json["histogram"] = {{"low", s.low}, {"high", s.high}, {"counts", s.histogram}};
  }
  return json;
}

/// Digits that tell a thousandth of the range from the next: six, more where the range is little beside the values.
int digits_for(const Statistics& s) {
  const double most = std::max(std::fabs(double(s.low)), std::fabs(double(s.high)));
  const double span = double(s.high) - double(s.low);
  return span > 0.0 ? std::clamp(6 - int(std::floor(std::log10(span / most))), 6, 17) : 6;
}

void print(const StoredVolume& volume, const Statistics& s) {
  const Lattice& lattice = volume.lattice();
  const Vec3 spacing = lattice.frame.spacing();
  const Vec3& o = lattice.frame.origin;
  fmt::print("volume   {}\n", volume.name);
  fmt::print("dims     {} x {} x {}\n", lattice.size.x, lattice.size.y, lattice.size.z);
  fmt::print("type     {}\n", scalar_type_name(volume.stored_type));
  fmt::print("spacing  {:g} x {:g} x {:g}\n", spacing.x, spacing.y, spacing.z);
  fmt::print("origin   {:g}, {:g}, {:g} in {}\n", o.x, o.y, o.z, volume.space);
  if (s.not_finite > 0) fmt::print("voxels that are infinite or not a number: {}\n", s.not_finite);
  if (s.moments.count == 0) return;
  const int digits = digits_for(s);
  fmt::print("range    {:.{}g} to {:.{}g}, mean {:.{}g}, standard deviation {:g}\n", s.low, digits, s.high, digits,
             s.moments.mean, digits, s.moments.standard_deviation);
  fmt::print("{} bins: where each begins, its voxels, and a bar of their logarithm\n", kBins);
  const std::size_t most = *std::max_element(s.histogram.begin(), s.histogram.end());
  const double step = (double(s.high) - double(s.low)) / double(kBins);
  for (std::size_t b = 0; b < kBins; ++b) {
    // Linear bars of the background would hide everything else.
    const double bar =
        s.histogram[b] > 0 ? 1.0 + 49.0 * std::log(double(s.histogram[b])) / std::log(double(most) + 1.0) : 0.0;
    fmt::print("  {:>12.{}g} {:>10}  {}\n", double(s.low) + step * double(b), digits - 1, s.histogram[b],
               std::string(std::size_t(bar), '#'));
  }
}

}  // namespace

void add_info_command(CLI::App& program, Session& session) {
  CLI::App& command = *program.add_subcommand("info", "Dims, spacing, type, value range and histogram of a volume");
  struct Options {
    VolumeOptions volume;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  options->volume.add_to(command, session);
  command.add_flag("--json", options->json, "as JSON");
  session.add_common_options(command);
  command.callback([options, &session] {
    session.on_run([options, &session] {
      const StoredVolume volume = options->volume.read_as_is(session);
      const Statistics s = std::visit([](const auto& grid) { return statistics(grid.values()); }, volume.values);
      if (options->json) {
        put_out(to_json(volume, s).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
      } else {
        print(volume, s);
      }
    });
  });
}

}  // namespace isolux
