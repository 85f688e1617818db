#include <fmt/format.h>
#include <fmt/ostream.h>
#include <isolux/core/error.h>
#include <isolux/core/field.h>
#include <isolux/resample/light_reader.h>
#include <isolux/volume_io/atomic_file.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>

#include "commands.h"
#include "light_options.h"
#include "parse.h"
#include "volume_options.h"

namespace isolux {
namespace {

struct Options {
  VolumeOptions volume;
  LightOptions light;
  SideOption side;
  std::string points;
  std::string output;
};

/// Three numbers with commas, semicolons or blanks between; further columns are passed over. Nothing if the first is no
/// number.
std::optional<Vec3> parse_point(std::string line) {
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == ',' || c == ';' || c == '\t'; }, ' ');
  std::istringstream words(line);
  Vec3 point(0.0);
  for (int a = 0; a < 3; ++a) {
    std::string word;
    words >> word;
    try {
      point[a] = parse_number("coordinate", word);
    } catch (const InvalidInput&) {
      return std::nullopt;
    }
  }
  return point;
}

std::vector<Vec3> read_points(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw IoError(fmt::format("{}: cannot open the points", path));
  std::vector<Vec3> points;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())) != 0) line.pop_back();
    if (line.empty() || line[0] == '#') continue;
    const auto point = parse_point(line);
    if (point) {
      points.push_back(*point);
    } else if (number > 1) {  // the first line may name the columns
      throw InvalidInput(fmt::format("{}: line {}: '{}' where three numbers x,y,z are wanted", path, number, line));
    }
  }
  if (file.bad()) throw IoError(fmt::format("{}: cannot read the points: is it a file?", path));
  return points;
}

/// The point in index space, moved by rounding errors at most into the box; nothing outside it.
std::optional<Vec3> inside(const Lattice& lattice, const Vec3& world) {
  Vec3 index = lattice.frame.index(world);
  for (int a = 0; a < 3; ++a) {
    const double last = lattice.size[a] - 1;
    const double slack = 1e-6 * last;
    if (!(index[a] >= -slack && index[a] <= last + slack)) return std::nullopt;
    index[a] = std::clamp(index[a], 0.0, last);
  }
  return index;
}

void run_probe(const Options& options, Session& session) {
  if (!options.light.given()) throw UsageError("--light is required: the light to read at the points");
  const Volume volume = options.volume.read(session);
  const LightFile light = options.light.read(volume, session);
  const std::vector<Vec3> points = session.timed("read", [&] { return read_points(options.points); });
  const TrilinearField field(volume);
  const LightReader reader(volume, options.light.of_side(light, options.side.or_outer()), TexelStorage::kBricks,
                           session.run);
  std::size_t outside = 0;
  session.timed("write", [&] {
    write_atomically(options.output, [&](std::ostream& out) {
      out << (light.grid.channels == 3 ? "x,y,z,isovalue,e_r,e_g,e_b\n" : "x,y,z,isovalue,e\n");
      for (const Vec3& p : points) {
        const auto index = inside(volume.lattice(), p);
        if (!index) ++outside;
        const double nan = std::numeric_limits<double>::quiet_NaN();
        const Vec3f e = index ? reader.at_index(*index) : Vec3f(float(nan));
        fmt::print(out, "{},{},{},{:.9g}", p.x, p.y, p.z, index ? field.value(*index) : nan);
        for (int c = 0; c < light.grid.channels; ++c) fmt::print(out, ",{:.9g}", e[c]);
        out << '\n';
      }
    });
  });
  session.report["points"] = points.size();
  session.report["points_outside"] = outside;
  if (outside > 0)
    session.warn(fmt::format("{} of {} points lie outside the volume's box; their isovalue and light are nan", outside,
                             points.size()));
}

}  // namespace

void add_probe_command(CLI::App& program, Session& session) {
  CLI::App& command = *program.add_subcommand("probe", "The light at points: x,y,z (world) in; x,y,z,isovalue,e out");
  const auto options = std::make_shared<Options>();
  options->volume.add_to(command);
  options->light.add_to(command);
  options->side.add_to(command, "whose light: outer (default), or inner where the light has both");
  command.add_option("--points", options->points, "one point a line; a first line may name the columns")
      ->required()
      ->type_name("IN.csv");
  command.add_option("-o,--output", options->output, "the table to write")->required()->type_name("OUT.csv");
  session.add_common_options(command);
  command.callback([options, &session] { session.on_run([options, &session] { run_probe(*options, session); }); });
}

}  // namespace isolux
