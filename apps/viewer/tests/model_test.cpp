#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/read.h>

#include <atomic>
#include <chrono>
#include <future>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "model/background_task.h"
#include "model/histogram.h"
#include "model/surface.h"
#include "model/surface_worker.h"

namespace isolux::viewer {
namespace {

Volume volume_of(std::vector<float> values) {
  const Lattice lattice{.size = {int(values.size()) / 4, 2, 2}, .frame = {}};
  Volume volume;
  volume.values = Grid<float>(lattice, std::move(values));
  return volume;
}

TEST(Histogram, CountsEveryValueOnce) {
  const Histogram histogram = make_histogram(volume_of({0, 0, 0, 1, 2, 3, 4, 5, 5, 5, 5, 10}));
  std::uint64_t sum = 0;
  for (const auto count : histogram.counts) sum += count;
  EXPECT_EQ(sum, 12u);
  EXPECT_EQ(histogram.counts.front(), 3u);
  EXPECT_EQ(histogram.counts.back(), 1u);
}

TEST(Histogram, PartsTwoClassesBetweenThem) {
  const double threshold =
      otsu_threshold(make_histogram(volume_of({10, 11, 12, 10, 11, 12, 10, 11, 200, 201, 199, 200})));
  EXPECT_GT(threshold, 12.0);
  EXPECT_LT(threshold, 199.0);
}

TEST(Histogram, GivesAConstantVolumeItsValueInTheMiddleWhereTheSliderHasIt) {
  const Histogram histogram = make_histogram(volume_of(std::vector<float>(8, 3.0f)));
  EXPECT_EQ(otsu_threshold(histogram), 3.0);
  EXPECT_EQ(histogram.counts[Histogram::kSteps / 2], 8u);
}

/// Surfaces that only carry their settings; each waits until it is let through.
class Gate {
 public:
  Surface pass(const ExtractSettings& settings, IndexedMesh memory, const std::stop_token& stop) {
    ++entered;
    while (!open) {
      if (stop.stop_requested()) throw Cancelled("interrupted");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    Surface surface;
    surface.settings = settings;
    surface.mesh = std::move(memory);
    return surface;
  }
  std::atomic<int> entered{0};
  std::atomic<bool> open{false};
};

TEST(SurfaceWorker, MakesTheNewestRequestAndSkipsThoseBetween) {
  Gate gate;
  SurfaceWorker worker([&](const ExtractSettings& s, IndexedMesh m,
                           const std::stop_token& stop) { return gate.pass(s, std::move(m), stop); },
                       [] {});
  EXPECT_TRUE(worker.idle());
  worker.request({.isovalue = 0.0f});
  while (gate.entered == 0) std::this_thread::yield();
  for (int i = 1; i <= 100; ++i) worker.request({.isovalue = float(i)});
  EXPECT_FALSE(worker.idle());
  gate.open = true;
  float last = -1.0f;
  while (!worker.idle()) {
    if (const auto surface = worker.take()) last = surface->settings.isovalue;
    std::this_thread::yield();
  }
  EXPECT_EQ(last, 100.0f);
  EXPECT_EQ(gate.entered, 2);
}

TEST(SurfaceWorker, StopsInTheMiddleOfASurface) {
  Gate gate;
  {
    SurfaceWorker worker([&](const ExtractSettings& s, IndexedMesh m,
                             const std::stop_token& stop) { return gate.pass(s, std::move(m), stop); },
                         [] {});
    worker.request({});
    while (gate.entered == 0) std::this_thread::yield();
  }
  EXPECT_EQ(gate.entered, 1);
}

TEST(SurfaceWorker, UsesTheMemoryOfAMeshThatCameBack) {
  Gate gate;
  gate.open = true;
  SurfaceWorker worker([&](const ExtractSettings& s, IndexedMesh m,
                           const std::stop_token& stop) { return gate.pass(s, std::move(m), stop); },
                       [] {});
  IndexedMesh mesh;
  mesh.positions.resize(1000);
  const Vec3f* memory = mesh.positions.data();
  worker.recycle(std::move(mesh));
  worker.request({});
  std::optional<Surface> surface;
  while (!(surface = worker.take())) std::this_thread::yield();
  EXPECT_EQ(surface->mesh.positions.data(), memory);
}

TEST(SurfaceMaker, MakesTheSurfaceOfEveryBackend) {
  const auto volume = std::make_shared<const ViewedVolume>(read_volume("gen:sphere:24"));
  const Registry<Extractor> registry = extractors();
  for (const BackendInfo& info : registry.backends()) {
    SurfaceMaker maker(volume, registry, {.name = info.name, .settings = {}});
    Surface surface;
    for (const float radius : {0.4f, 0.25f}) {
      surface = maker.make({.isovalue = -radius}, std::move(surface.mesh), {});
      EXPECT_EQ(surface.error, "");
      ASSERT_GT(surface.mesh.triangles.size(), 100u) << info.name;
      ASSERT_EQ(surface.mesh.normals.size(), surface.mesh.positions.size());
      for (std::size_t i = 0; i < surface.mesh.positions.size(); ++i) {
        const Vec3f out = surface.mesh.positions[i] - Vec3f(0.5f);
        // A chord of a cell's diagonal lies at most 3 (1/23)^2 / (8 r) = .003 within the sphere; normals by
        // differences.
        ASSERT_NEAR(glm::length(out), radius, 3e-3) << info.name;
        ASSERT_GT(glm::dot(surface.mesh.normals[i], glm::normalize(out)), 0.99f) << info.name;
      }
    }
  }
}

TEST(ViewedVolume, MakesFloatsOfANarrowVolumeOnce) {
  Lattice lattice;
  lattice.size = Index3(2);
  const ViewedVolume narrow(StoredVolume{.values = Grid<std::int16_t>(lattice, {1, -2, 3, 4, 5, 6, 7, 800}),
                                         .name = "narrow",
                                         .stored_type = ScalarType::kInt16,
                                         .space = {}});
  EXPECT_TRUE(std::holds_alternative<std::span<const std::int16_t>>(narrow.stored().voxels()));
  const Volume& floats = narrow.floats();
  EXPECT_EQ(&narrow.floats(), &floats);
  EXPECT_EQ(floats.values(1, 1, 1), 800.0f);
  EXPECT_EQ(floats.values(1, 0, 0), -2.0f);
  EXPECT_EQ(floats.name, "narrow");
  // Floats are not held twice.
  const ViewedVolume wide(read_volume("gen:sphere:4"));
  EXPECT_EQ(std::get<std::span<const float>>(wide.stored().voxels()).data(), wide.floats().values.values().data());
}

TEST(BackgroundTask, HandsOverTheResultOrTheReason) {
  for (const bool fails : {false, true}) {
    std::promise<void> done;
    std::atomic<int> calls{0};
    BackgroundTask<int> worker(
        {},
        [&](const isolux::Run& run) {
          run.progress("trace", 0.5);
          if (fails) throw InvalidInput("no light today");
          return 7;
        },
        [&] {
          // Once for the progress, once for the outcome.
          if (++calls == 2) done.set_value();
        });
    done.get_future().wait();
    EXPECT_EQ(worker.progress().stage, "trace");
    EXPECT_EQ(worker.progress().fraction, 0.5);
    const auto outcome = worker.take();
    ASSERT_TRUE(outcome.has_value());
    EXPECT_EQ(outcome->result.value_or(0), fails ? 0 : 7);
    EXPECT_EQ(outcome->error, fails ? "no light today" : "");
    EXPECT_FALSE(worker.take().has_value());
  }
}

}  // namespace
}  // namespace isolux::viewer
