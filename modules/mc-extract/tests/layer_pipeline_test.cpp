// What the pipeline of layers keeps apart, and that threads leave no trace.
#include "layer_pipeline.h"

#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/mc_extract.h>

#include <atomic>

#include "fields.h"

namespace isolux {
namespace {

using namespace isolux::testing;

TEST(LayerPipeline, GivesTheSameForAnyNumberOfThreads) {
  const Volume volume = noise(Index3(40, 31, 67), 9);
  const ExtractSettings settings{.isovalue = 0.4f};
  IndexedMesh expected;
  IsoExtractor(volume).extract(settings, {.threads = 1}, expected);
  for (const int threads : {2, 3, 8}) {
    IndexedMesh mesh;
    IsoExtractor(volume).extract(settings, {.threads = threads}, mesh);
    EXPECT_TRUE(expected.positions == mesh.positions && expected.normals == mesh.normals) << threads;
    EXPECT_TRUE(expected.triangles == mesh.triangles) << threads;
  }
}

TEST(LayerPipeline, PassesOnWhatAStageThrows) {
  for (const int threads : {1, 2, 4}) {
    for (const int failing : {0, 5, 19}) {
      const auto nothing = [](int) {};
      mc::LayerPipeline pipeline(20, {.classify = nothing,
                                      .count =
                                          [&](int layer) {
                                            if (layer == failing) throw InvalidInput("no");
                                          },
                                      .number = [](int) { return false; },
                                      .grow = {},
                                      .write = nothing,
                                      .connect = nothing});
      EXPECT_THROW(pipeline.run({.threads = threads}), InvalidInput);
    }
  }
}

TEST(LayerPipeline, GrowsOnlyWhileNothingIsWritten) {
  for (const int threads : {1, 2, 4}) {
    std::atomic<int> writing = 0;
    std::atomic<int> written = 0;
    int room = 0;
    int needed = 0;
    std::atomic<int> wrong = 0;
    const auto write = [&](int layer) {
      ++writing;
      if (layer >= room) ++wrong;  // read and grown without a lock: the pipeline keeps them apart
      ++written;
      --writing;
    };
    mc::LayerPipeline pipeline(200, {.classify = [](int) {},
                                     .count = [](int) {},
                                     .number =
                                         [&](int layer) {
                                           needed = layer + 1;
                                           return needed > room;
                                         },
                                     .grow =
                                         [&] {
                                           if (writing != 0) ++wrong;
                                           room = needed + 3;
                                         },
                                     .write = write,
                                     .connect = write});
    pipeline.run({.threads = threads});
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(written, 400);
  }
}

}  // namespace
}  // namespace isolux
