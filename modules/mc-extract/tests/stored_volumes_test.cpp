// Volumes in the type of their file against the same in floats: every backend, bit for bit.
#include <gtest/gtest.h>
#include <isolux/mc_extract.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "fields.h"
#include "mesh_laws.h"
#include "wide_targets.h"

namespace isolux {
namespace {

using namespace isolux::testing;

template <class Value>
constexpr int kLow = std::numeric_limits<Value>::min();
template <class Value>
constexpr int kHigh = std::numeric_limits<Value>::max();

/// Smooth waves through the whole range of the type, with noise of all its bits at every tenth point, and the ends of
/// the range themselves.
template <class Value>
StoredVolume waves(const Index3& size) {
  RandomStream random(7, 0);
  std::vector<Value> values;
  const double middle = 0.5 * (double(kLow<Value>) + kHigh<Value>);
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i)
        values.push_back(random.next_bits() % 10 == 0
                             ? Value(random.next_bits())
                             : Value(middle + 0.99 * (kHigh<Value> - middle) * std::sin(0.5 * i + 0.4 * j) *
                                                  std::cos(0.3 * k - 0.2 * j)));
  values[values.size() / 2] = Value(kLow<Value>);
  values.back() = Value(kHigh<Value>);
  return {.values = Grid<Value>(Lattice{.size = size, .frame = unit_cube(40)}, std::move(values)),
          .name = "waves",
          .stored_type = {},
          .space = {}};
}

/// Isovalues on, between and beyond whole numbers, and none.
template <class Value>
std::vector<float> isovalues() {
  const auto low = float(kLow<Value>);
  const auto high = float(kHigh<Value>);
  return {-1e30f,
          low - 1.0f,
          low,
          low + 0.5f,
          low + 1.0f,
          100.0f,
          100.25f,
          high - 0.5f,
          high,
          high + 0.25f,
          high + 1.0f,
          1e30f,
          std::numeric_limits<float>::infinity(),
          std::numeric_limits<float>::quiet_NaN()};
}

template <class Value>
class StoredVolumes : public ::testing::Test {
 protected:
  /// Rows of less and of more than a word, and volumes of less than one.
  const std::vector<Index3> sizes_ = {{130, 21, 17}, {64, 5, 4}, {40, 9, 7}, {5, 3, 2}, {2, 2, 2}};
};
using NarrowTypes = ::testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t>;
TYPED_TEST_SUITE(StoredVolumes, NarrowTypes);

TYPED_TEST(StoredVolumes, GiveTheSameSurfaceAsFloats) {
  for (const Index3& size : this->sizes_) {
    const StoredVolume stored = waves<TypeParam>(size);
    const Volume floats = to_floats(stored);
    IsoExtractor of_floats(floats, {}, IsoExtractor::Index::kNone);
    for (const IsoExtractor::Index index : {IsoExtractor::Index::kBricks, IsoExtractor::Index::kNone}) {
      IsoExtractor of_stored(stored, {}, index);
      for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
        for (const float isovalue : isovalues<TypeParam>()) {
          const ExtractSettings settings{.isovalue = isovalue, .outer = outer};
          IndexedMesh a;
          IndexedMesh b;
          of_stored.extract(settings, {}, a);
          of_floats.extract(settings, {}, b);
          EXPECT_TRUE(identical(a, b)) << isovalue << " of " << size.x;
          IsoMesh c;
          IsoMesh d;
          of_stored.extract(settings, {}, c);
          of_floats.extract(settings, {}, d);
          EXPECT_TRUE(identical(c, d)) << isovalue << " of " << size.x;
        }
      }
    }
  }
}

TYPED_TEST(StoredVolumes, GiveTheSameMeshByEveryBackendAndSetting) {
  const StoredVolume stored = waves<TypeParam>(Index3(23, 12, 40));
  const Volume floats = to_floats(stored);
  const float middle = 0.5f * (float(kLow<TypeParam>) + float(kHigh<TypeParam>));
  const Registry<Extractor> registry = extractors();
  for (const BackendInfo& info : registry.backends()) {
    const auto extractor = registry.create(info.name);
    for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
      for (const NormalKind normals : {NormalKind::kGradient, NormalKind::kAccurate}) {
        for (const CapKind cap : {CapKind::kNone, CapKind::kBox}) {
          const ExtractSettings settings{
              .isovalue = middle, .outer = outer, .normals = normals, .cap = cap, .min_component = 8};
          const IsoMesh mesh = extractor->extract(stored, settings, {});
          EXPECT_GT(mesh.n_faces(), 500U);
          EXPECT_TRUE(identical(mesh, extractor->extract(floats, settings, {}))) << info.name;
        }
      }
    }
  }
}

TYPED_TEST(StoredVolumes, GiveTheSameBitsOnEveryInstructionSet) {
  const StoredVolume stored = waves<TypeParam>(Index3(75, 20, 13));
  for (const IsoExtractor::Index index : {IsoExtractor::Index::kBricks, IsoExtractor::Index::kNone}) {
    const auto surface = [&] {
      IndexedMesh mesh;
      IsoExtractor(stored, {}, index).extract({.isovalue = 100.0f}, {}, mesh);
      return mesh;
    };
    const IndexedMesh expected = surface();
    test::on_every_target([&] { EXPECT_TRUE(identical(expected, surface())); });
  }
}

}  // namespace
}  // namespace isolux
