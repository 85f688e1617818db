// A volume in its file's type is the same field as in floats.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/core/field.h>
#include <isolux/core/random.h>

#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace isolux {
namespace {

// What needs floats does not compile with anything else, so that nobody finds out at run time; and the way there is
// written down by the caller, as it costs memory.
static_assert(!std::is_convertible_v<StoredVolume, Volume>);
static_assert(!std::is_constructible_v<TrilinearField, const StoredVolume&>);
static_assert(std::is_convertible_v<const StoredVolume&, VolumeView> &&
              std::is_convertible_v<const Volume&, VolumeView>);

constexpr Index3 kSize(7, 5, 4);

/// Values of all bits, the ends of the type among them.
template <class Value>
StoredVolume example() {
  std::vector<Value> values(kSize.x * kSize.y * kSize.z);
  RandomStream random(3, 0);
  for (Value& value : values) value = Value(random.next_bits());
  values[50] = std::numeric_limits<Value>::min();
  values.back() = std::numeric_limits<Value>::max();
  return {.values = Grid<Value>(Lattice{.size = kSize, .frame = {}}, std::move(values)),
          .name = "example",
          .stored_type = ScalarType::kUint16,
          .space = "3D-right-handed"};
}

template <class Value>
class StoredVolumes : public ::testing::Test {};
using NarrowTypes = ::testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t>;
TYPED_TEST_SUITE(StoredVolumes, NarrowTypes);

TYPED_TEST(StoredVolumes, HaveTheSameValuesAsFloats) {
  const StoredVolume stored = example<TypeParam>();
  const Volume floats = to_floats(stored);
  EXPECT_EQ(floats.name, stored.name);
  EXPECT_EQ(floats.stored_type, stored.stored_type);
  EXPECT_EQ(floats.space, stored.space);
  const VolumeView view = stored;
  std::vector<float> part(40);
  view.copy(30, part);
  for (std::size_t i = 0; i < part.size(); ++i) EXPECT_EQ(part[i], floats.values.values()[30 + i]);
  for (int k = 0; k < kSize.z; ++k)
    for (int j = 0; j < kSize.y; ++j)
      for (int i = 0; i < kSize.x; ++i) EXPECT_EQ(view(i, j, k), floats.values(i, j, k));
  EXPECT_EQ(value_range(stored).low, float(std::numeric_limits<TypeParam>::min()));
  EXPECT_EQ(value_range(stored).high, float(std::numeric_limits<TypeParam>::max()));
  EXPECT_NO_THROW(require_usable(stored));
}

TYPED_TEST(StoredVolumes, AreTheSameFieldAsFloats) {
  const StoredVolume stored = example<TypeParam>();
  const Volume floats = to_floats(stored);
  const TrilinearFieldOf<TypeParam> a(stored.lattice(), std::get<Grid<TypeParam>>(stored.values).values());
  const TrilinearField b(floats);
  RandomStream random(4, 0);
  for (int n = 0; n < 200; ++n) {
    const double x = random.uniform_float();
    const double y = random.uniform_float();
    const Vec3 p = Vec3(x, y, random.uniform_float()) * Vec3(kSize);
    EXPECT_EQ(a.value(p), b.value(p));
    EXPECT_EQ(a.cell_gradient(p), b.cell_gradient(p));
    EXPECT_EQ(a.normal(p, OuterSide::kLower, GradientKind::kCentralDifferences),
              b.normal(p, OuterSide::kLower, GradientKind::kCentralDifferences));
  }
}

TEST(StoredVolume, KeepsFloatsWhereTheyAre) {
  Volume volume;
  volume.values = Grid<float>(Lattice{.size = kSize, .frame = {}}, 1.5f);
  const float* place = volume.values.values().data();
  StoredVolume stored = keep_floats(std::move(volume));
  EXPECT_EQ(std::get<Grid<float>>(stored.values).values().data(), place);
  EXPECT_EQ(to_floats(std::move(stored)).values.values().data(), place);
}

TEST(StoredVolume, NeedsTwoGridPointsAnAxis) {
  const StoredVolume flat{.values = Grid<std::uint8_t>(Lattice{.size = Index3(4, 1, 4), .frame = {}}),
                          .name = "flat.nrrd",
                          .stored_type = ScalarType::kUint8,
                          .space = {}};
  try {
    require_usable(flat);
    FAIL() << "taken";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("flat.nrrd: 4x1x4 grid points"));
  }
}

}  // namespace
}  // namespace isolux
