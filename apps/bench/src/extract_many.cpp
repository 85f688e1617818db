#include "extract_many.h"

#include <fmt/format.h>
#include <isolux/mc_extract/iso_extractor.h>
#include <isolux/volume_io/analytic_fields.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "peer_vtk.h"
#include "stats.h"

namespace isolux::bench {
namespace {

struct Subject {
  std::string name;
  std::string field;
  int n;
  std::vector<float> isovalues;
  bool bytes = false;  ///< rounded to 0 to 255, as most scans come
};

constexpr float kLargest = 1.5f;  ///< value of the gyroid

float to_byte(float value) { return 127.5f * (1.0f + value / kLargest); }

/// `count` isovalues through the middle 90 % of the gyroid's range.
std::vector<float> sweep(int count) {
  std::vector<float> isovalues;
  for (int i = 0; i < count; ++i) isovalues.push_back(kLargest * 0.9f * (2.0f * float(i) / float(count - 1) - 1.0f));
  return isovalues;
}

std::vector<Subject> subjects(const SuiteContext& context) {
  const int dense = context.pick(24, 128, 256);
  const int sparse = context.pick(24, 192, 512);
  const int count = context.pick(3, 10, 50);
  const std::string sweeps = fmt::format("sweep of {} isovalues", count);
  std::vector<float> of_bytes = sweep(count);
  std::ranges::transform(of_bytes, of_bytes.begin(), to_byte);
  return {{sweeps, "gyroid", dense, sweep(count)},
          {sweeps + ", 8-bit volume in its own type", "gyroid", dense, of_bytes, true},
          {"a small sphere", "sphere", sparse, {-0.12f}},
          {"small balls everywhere", "gyroid", sparse, {1.49f}}};
}

StoredVolume volume_of(const Subject& subject) {
  Volume floats = sample_analytic_field(subject.field, subject.n);
  if (!subject.bytes) return keep_floats(std::move(floats));
  std::vector<std::uint8_t> bytes;
  bytes.reserve(floats.values.values().size());
  for (const float value : floats.values.values())
    bytes.push_back(std::uint8_t(std::clamp(std::round(to_byte(value)), 0.0f, 255.0f)));
  return {.values = Grid(floats.lattice(), std::move(bytes)),
          .name = floats.name,
          .stored_type = ScalarType::kUint8,
          .space = floats.space};
}

/// Seconds an isovalue, all one after the other into one mesh.
double ours(IsoExtractor& extractor, const Subject& subject, const Run& run, std::size_t& triangles) {
  IndexedMesh mesh;
  const auto all = [&] {
    triangles = 0;
    for (const float isovalue : subject.isovalues) {
      extractor.extract({.isovalue = isovalue}, run, mesh);
      triangles += mesh.triangles.size();
    }
  };
  all();
  return timed(all, 5, 3.0).value / double(subject.isovalues.size());
}

Cell flying_edges(const Subject& subject, const VolumeView& volume, int threads) {
  std::vector<float> copy(volume.lattice().count());
  volume.copy(0, copy);
  double seconds = 0.0;
  for (const float isovalue : subject.isovalues) {
    const VtkExtraction peer =
        vtk_flying_edges(copy, subject.n, isovalue, threads, subject.isovalues.size() > 1 ? 1 : 5);
    if (peer.seconds.empty()) return "";
    seconds += median(peer.seconds).value;
  }
  return 1e3 * seconds / double(subject.isovalues.size());
}

}  // namespace

Table extract_many(const SuiteContext& context) {
  Table table{.id = "many",
              .title = "Sweeps, and small surfaces in large volumes",
              .columns = {"what", "n", "triangles an isovalue", "ms, no index", "ms, with the index", "index, ms once",
                          "VTK Flying Edges, ms"},
              .sentence =
                  "Indexed meshes with normals into kept memory, milliseconds an isovalue, all on the same "
                  "number of threads. The index is made once a volume. Flying Edges reads floats."};
  Run run = context.run;
  run.threads = run.threads > 0 ? run.threads : 2;
  for (const Subject& subject : subjects(context)) {
    context.say(fmt::format("{} of {} {}", subject.name, subject.field, subject.n));
    const StoredVolume volume = volume_of(subject);
    std::size_t triangles = 0;
    IsoExtractor plain(volume, run, IsoExtractor::Index::kNone);
    const double without = ours(plain, subject, run, triangles);
    const Estimate build = timed([&] { IsoExtractor(volume, run, IsoExtractor::Index::kBricks); }, 3, 2.0);
    IsoExtractor indexed(volume, run, IsoExtractor::Index::kBricks);
    const double with = ours(indexed, subject, run, triangles);
    table.rows.push_back({subject.name, double(subject.n), double(triangles) / double(subject.isovalues.size()),
                          1e3 * without, 1e3 * with, 1e3 * build.value, flying_edges(subject, volume, run.threads)});
  }
  return table;
}

}  // namespace isolux::bench
