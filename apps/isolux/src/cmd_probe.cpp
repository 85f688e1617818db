#include <fmt/format.h>
#include <fmt/ostream.h>
#include <fmt/ranges.h>
#include <isolux/core/field.h>
#include <isolux/mc_extract/vertex_resolution.h>
#include <isolux/resample/light_reader.h>
#include <isolux/volume_io/atomic_file.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <optional>

#include "commands.h"
#include "light_options.h"
#include "point_table.h"
#include "volume_options.h"

namespace isolux {
namespace {

struct ProbeOptions {
  VolumeOptions volume;
  LightOptions light;
  SideOption side;
  std::string points;
  std::string output;
};

/// A volume's box, a little wider: by what rounding errors may move a point on its faces.
class Box {
 public:
  explicit Box(const Lattice& lattice) : lattice_(lattice), margin_(vertex_margin(lattice)) {
    // Half a voxel at most: where floats tell less apart, only points that are known better are taken.
    const Vec3 of_mesh = glm::min(8.0 * vertex_resolution(lattice), 0.5);
    slack_ = glm::max(1e-6 * Vec3(lattice.size - 1), of_mesh);
  }

  /// The point in index space, moved by the slack at most into the box; nothing outside it.
  [[nodiscard]] std::optional<Vec3> inside(const Vec3& world) const {
    Vec3 index = lattice_.frame.index(world);
    for (int a = 0; a < 3; ++a) {
      const double last = lattice_.size[a] - 1;
      if (!(index[a] >= -slack_[a] && index[a] <= last + slack_[a])) return std::nullopt;
      index[a] = std::clamp(index[a], 0.0, last);
    }
    return index;
  }

  /// By how much the isovalue of a mesh's vertex may be off: for the rounding of its coordinates and of the voxels, and
  /// for being kept away from grid points.
  [[nodiscard]] double isovalue_slack(const TrilinearField& field, const Vec3& index, double largest_voxel) const {
    constexpr double kUlps = 4.0;
    const double of_voxels = kUlps * double(std::numeric_limits<float>::epsilon()) * largest_voxel;
    return glm::dot(glm::abs(field.cell_gradient(index)), slack_ + margin_) + of_voxels;
  }

 private:
  Lattice lattice_;
  Vec3 slack_;
  Vec3 margin_;  ///< how far vertices of our meshes keep from grid points
};

/// Whether the level set of an isovalue that is known within `slack` was lit.
bool may_be_lit(const LightDetail& detail, double isovalue, double slack) {
  return !detail.isovalues ||
         (isovalue + slack >= double(detail.isovalues->low) && isovalue - slack <= double(detail.isovalues->high));
}

/// A field of a table parted by commas, in front of which one stands.
std::string next_field(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return "," + text;
  std::string quoted = ",\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string next_fields(const std::vector<std::string>& texts) {
  std::string fields;
  for (const std::string& text : texts) fields += next_field(text);
  return fields;
}

bool is_among(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The names of a table's other columns, those changed that probe has for its own.
std::vector<std::string> told_apart(std::vector<std::string> names, const std::vector<std::string>& own,
                                    const ProbeOptions& options, const Session& session) {
  for (std::string& name : names) {
    if (!is_among(own, name)) continue;
    std::string other = name;
    do {
      other += "_in";
    } while (is_among(own, other) || is_among(names, other));
    session.say(fmt::format("{}: its column '{}' is '{}' in {}", options.points, name, other, options.output));
    name = other;
  }
  return names;
}

void run_probe(const ProbeOptions& options, Session& session) {
  if (!options.light.given()) throw UsageError("--light is required: the light to read at the points");
  const Volume volume = options.volume.read(session);
  const LightFile light = options.light.read(volume, session);
  const PointTable table = session.timed("read", [&] { return read_point_table(options.points); });
  const std::vector<Vec3>& points = table.points;
  std::vector<std::string> own{"x", "y", "z", "isovalue", "e"};
  if (light.grid.channels == 3) own = {"x", "y", "z", "isovalue", "e_r", "e_g", "e_b"};
  const std::vector<std::string> names = told_apart(table.names, own, options, session);
  const Box box(volume.lattice());
  const TrilinearField field(volume);
  const LightReader reader(volume, options.light.of_side(light, options.side.or_outer()), TexelStorage::kBricks,
                           session.run);
  const LightDetail& detail = light.grid.detail;
  const ValueRange range = value_range(volume);
  const double largest_voxel = double(std::max(-range.low, range.high));
  std::size_t outside = 0;
  std::size_t unlit = 0;
  session.timed("write", [&] {
    write_atomically(options.output, [&](std::ostream& out) {
      out << fmt::format("{}", fmt::join(own, ",")) << next_fields(names) << '\n';
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3& p = points[i];
        const auto index = box.inside(p);
        if (!index) ++outside;
        const double nan = std::numeric_limits<double>::quiet_NaN();
        const double isovalue = index ? field.value(*index) : nan;
        if (index && !may_be_lit(detail, isovalue, box.isovalue_slack(field, *index, largest_voxel))) ++unlit;
        const Vec3f e = index ? reader.at_index(*index) : Vec3f(float(nan));
        fmt::print(out, "{},{},{},{:.9g}", p.x, p.y, p.z, isovalue);
        for (int c = 0; c < light.grid.channels; ++c) fmt::print(out, ",{:.9g}", e[c]);
        out << next_fields(table.others[i]) << '\n';
      }
    });
  });
  session.report["points"] = points.size();
  session.report["points_outside"] = outside;
  session.report["points_outside_iso_range"] = unlit;
  if (unlit > 0)
    session.warn(
        fmt::format("{} of {} points lie on level sets outside the range {} to {} that the light is of: what is "
                    "read there is not their light",
                    unlit, points.size(), detail.isovalues->low, detail.isovalues->high));
  if (outside > 0)
    session.warn(fmt::format("{} of {} points lie outside the volume's box; their isovalue and light are nan", outside,
                             points.size()));
}

}  // namespace

void add_probe_command(CLI::App& program, Session& session) {
  CLI::App& command = *program.add_subcommand("probe", "The light at points: x,y,z (world) in; x,y,z,isovalue,e out");
  const auto options = std::make_shared<ProbeOptions>();
  options->volume.add_to(command, session);
  options->light.add_to(command, session);
  options->side.add_to(command, "whose light: outer (default), or inner where the light has both");
  session.reads(
      command
          .add_option("--points", options->points,
                      "one point a line, in the columns x, y and z if a first line names them, else in the first "
                      "three; other named columns go behind the light")
          ->required()
          ->type_name("IN.csv"));
  session.writes(
      command.add_option("-o,--output", options->output, "the table to write")->required()->type_name("OUT.csv"));
  session.add_common_options(command);
  command.callback([options, &session] { session.on_run([options, &session] { run_probe(*options, session); }); });
}

}  // namespace isolux
