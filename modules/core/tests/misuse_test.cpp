// What a library's user gets wrong is said in words and not read out of bounds.
#include <gtest/gtest.h>
#include <isolux/core.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace isolux::test {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

Volume rising_volume() {
  Volume volume{.values = Grid<float>(Lattice{.size = {4, 4, 4}, .frame = {}}), .name = "mine"};
  for (std::size_t i = 0; i < 64; ++i) volume.values.values()[i] = float(i);
  return volume;
}

TEST(Misuse, ValuesThatAreNotOneAPointAreRefused) {
  const Lattice lattice{.size = {4, 4, 4}, .frame = {}};
  EXPECT_THROW(Grid<float>(lattice, std::vector<float>(10)), InvalidInput);
  EXPECT_NO_THROW(Grid<float>(lattice, std::vector<float>(64)));
  std::vector<float> few(63);
  EXPECT_THROW(GridView<float>(lattice, few), InvalidInput);
  EXPECT_THROW(require_values({.size = {-4, -4, 4}, .frame = {}}, 64), InvalidInput);
}

TEST(Misuse, AxesThatSpanNoVolumeAreRefused) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Mat3& axes : {Mat3(0.0), Mat3(kNotANumber), Mat3(infinity), Mat3(1e-120), Mat3(2e38),
                           Mat3(Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0))}) {
    Volume volume = rising_volume();
    const auto values = volume.values.values();
    volume.values =
        Grid<float>({.size = {4, 4, 4}, .frame = {.origin = Vec3(0.0), .axes = axes}}, {values.begin(), values.end()});
    EXPECT_THROW(require_usable(volume), InvalidInput);
  }
  // Lengths and hands may be any.
  for (const Mat3& axes : {Mat3(1e-12), Mat3(-1e9), Mat3(Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0.9, 0, 0.1))})
    EXPECT_NO_THROW(require_spanning({.origin = Vec3(1e7), .axes = axes}, "mine"));
  EXPECT_THROW(require_spanning({.origin = Vec3(0, kNotANumber, 0), .axes = Mat3(1.0)}, "mine"), InvalidInput);
}

TEST(Misuse, PlacesThatAreNoNumbersCountAsTheAxisBeginning) {
  const Volume volume = rising_volume();
  const TrilinearField field(volume);
  EXPECT_EQ(field.value({kNotANumber, 2.0, 3.0}), field.value({0.0, 2.0, 3.0}));
  EXPECT_EQ(field.value(Vec3(kNotANumber)), 0.0);
  EXPECT_EQ(field.value(Vec3(std::numeric_limits<double>::infinity())), 63.0);
  EXPECT_EQ(field.value(Vec3(-1e300)), 0.0);
  IlluminationGrid light(cell_lattice(volume.lattice()), 1);
  light.values.front() = 2.0f;
  EXPECT_EQ(light.at_world(Vec3(kNotANumber)).x, 2.0f);
}

TEST(Misuse, LightsThatAreNotCompleteAreRefused) {
  const Lattice texels = cell_lattice(rising_volume().lattice());
  EXPECT_NO_THROW(require_complete(IlluminationGrid(texels, 3)));
  EXPECT_THROW(require_complete({}), InvalidInput);
  EXPECT_THROW(require_complete(IlluminationGrid(texels, 2)), InvalidInput);
  IlluminationGrid light(texels, 1);
  light.values.pop_back();
  EXPECT_THROW(require_complete(light), InvalidInput);
}

TEST(Misuse, BlocksOfNothingAreRefused) {
  EXPECT_THROW(parallel_blocks(10, 0, isolux::Run{}, "", [](const Block&) {}), InvalidInput);
}

class Stage {
 public:
  static constexpr std::string_view kStage = "stage";
  virtual ~Stage() = default;
};
class Backend : public Stage {
 public:
  using Options = NoOptions;
  explicit Backend(const Options& /*options*/) {}
};

TEST(Misuse, NamesOfBackendsAreChecked) {
  Registry<Stage> registry;
  registry.add<Backend>("first", "");
  EXPECT_THROW(registry.add<Backend>("", ""), InvalidInput);
  try {
    static_cast<void>(registry.create());
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_EQ(std::string(error.what()), "no stage has a default; there are first");
  }
  registry.set_default("first");
  EXPECT_THROW(registry.set_default("frist"), InvalidInput);
  EXPECT_NO_THROW(static_cast<void>(registry.create()));
}

template <class Of>
concept CanBeListed = requires(Of registry) {
  std::forward<Of>(registry).backends();
};

TEST(Misuse, AListOfATemporaryDoesNotCompile) {
  EXPECT_TRUE((CanBeListed<Registry<Stage>&>));
  EXPECT_FALSE((CanBeListed<Registry<Stage>>));
}

}  // namespace
}  // namespace isolux::test
