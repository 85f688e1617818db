#include "extract_many.h"

#include <fmt/format.h>
#include <isolux/mc_extract/iso_extractor.h>
#include <isolux/volume_io/analytic_fields.h>

#include <algorithm>
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
};

/// `count` isovalues through the middle 90 % of the gyroid's range.
std::vector<float> sweep(int count) {
  constexpr float kLargest = 1.5f;
  std::vector<float> isovalues;
  for (int i = 0; i < count; ++i) isovalues.push_back(kLargest * 0.9f * (2.0f * float(i) / float(count - 1) - 1.0f));
  return isovalues;
}

std::vector<Subject> subjects(const SuiteContext& context) {
  const int dense = context.pick(24, 128, 256);
  const int sparse = context.pick(24, 192, 512);
  const int count = context.pick(3, 10, 50);
  return {{fmt::format("sweep of {} isovalues", count), "gyroid", dense, sweep(count)},
          {"a small sphere", "sphere", sparse, {-0.12f}},
          {"small balls everywhere", "gyroid", sparse, {1.49f}}};
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

Cell flying_edges(const Subject& subject, const Volume& volume, int threads) {
  const auto values = volume.values.values();
  const std::vector<float> copy(values.begin(), values.end());
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
                  "number of threads. The index is made once a volume."};
  Run run = context.run;
  run.threads = run.threads > 0 ? run.threads : 2;
  for (const Subject& subject : subjects(context)) {
    context.say(fmt::format("{} of {} {}", subject.name, subject.field, subject.n));
    const Volume volume = sample_analytic_field(subject.field, subject.n);
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
