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

TEST(Misuse, MessagesAreOneLineWhateverTheyQuote) {
  using namespace std::string_literals;
  const InvalidInput error("'a\nb\0c\x1b[1m\x7F\xC3\xA4' is no type"s);
  EXPECT_STREQ(error.what(), "'a b c [1m \xC3\xA4' is no type");
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

// What a short step adds to a place is lost where a long one is added to the same coordinate.
TEST(Misuse, AxesThatDoNotTellGridPointsApartAreRefused) {
  const auto require = [](const Vec3& x, const Vec3& y, const Vec3& z) {
    require_places({.size = Index3(100), .frame = {.origin = Vec3(1e7), .axes = Mat3(x, y, z)}}, "mine");
  };
  EXPECT_NO_THROW(require({1e-20, 0, 0}, {0, 1e20, 0}, {0, 0, 1}));
  EXPECT_NO_THROW(require({1e-3, 0, 0}, {0, 1, 0}, {-0.3, 0, 1}));
  EXPECT_NO_THROW(require({0.6e-6, 0.8e-6, 0}, {-0.8, 0.6, 0}, {0, 0, 1}));
  EXPECT_THROW(require({1e-20, 0, 0}, {0, 2, 0}, {-0.26, 0, 3}), InvalidInput);
  EXPECT_THROW(require({0.6e-13, 0.8e-13, 0}, {-0.8, 0.6, 0}, {0, 0, 1}), InvalidInput);
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
  // Flat but at the first grid point: whatever lies beyond the box is as flat as its face.
  Volume flat{.values = Grid<float>(Lattice{.size = {6, 6, 6}, .frame = {}}), .name = "mine"};
  flat.values(0, 0, 0) = 1.0f;
  const TrilinearField mostly_flat(flat);
  EXPECT_TRUE(mostly_flat.is_flat_around(Vec3(1e300)));
  EXPECT_FALSE(mostly_flat.is_flat_around(Vec3(-1e300)));
  EXPECT_FALSE(mostly_flat.is_flat_around(Vec3(kNotANumber)));
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

TEST(Misuse, LightsWithSlopesOfSomeTexelsAreRefused) {
  IlluminationGrid light(cell_lattice(rising_volume().lattice()), 1);
  light.detail.slopes.assign(light.values.size(), 1.0f);
  for (std::vector<float>& slopes : light.detail.normal_slopes) slopes.assign(light.values.size(), 1.0f);
  EXPECT_NO_THROW(require_complete(light));
  light.detail.normal_slopes[2].clear();
  EXPECT_THROW(require_complete(light), InvalidInput);
  light.detail.normal_slopes = {};
  EXPECT_NO_THROW(require_complete(light));
  light.detail.normal_slopes[2].assign(light.values.size(), 1.0f);
  EXPECT_THROW(require_complete(light), InvalidInput);
  light.detail.normal_slopes[2].clear();
  light.detail.slopes.pop_back();
  EXPECT_THROW(require_complete(light), InvalidInput);
}

TEST(Misuse, BlocksOfNothingAreRefused) {
  EXPECT_THROW(parallel_blocks(10, 0, isolux::Run{}, "", [](const Block&) {}), InvalidInput);
}

TEST(Misuse, SizesThatNoMemoryHoldsAreRefused) {
  for (const Index3 size : {Index3(-1, 2, 3), Index3(-1, -2, 3), Index3(1 << 30, 1 << 30, 16)}) {
    const Lattice lattice{.size = size, .frame = {}};
    EXPECT_THROW(Grid<float>{lattice}, InvalidInput);
    EXPECT_THROW(Grid<float>(lattice, std::vector<float>(6)), InvalidInput);
    EXPECT_THROW(Grid<float>(lattice, std::vector<float>{}), InvalidInput);
    EXPECT_THROW(IlluminationGrid(lattice, 1), InvalidInput);
    EXPECT_THROW(TexelMask{size}, InvalidInput);
  }
  EXPECT_THROW(IlluminationGrid({.size = Index3(2), .frame = {}}, -1), InvalidInput);
  EXPECT_EQ(Grid<float>({.size = {0, 1 << 30, 1 << 30}, .frame = {}}).values().size(), 0u);
}

TEST(Misuse, AVolumeThatWasMovedIsNotUsable) {
  Volume volume = rising_volume();
  const Volume taken = std::move(volume);
  EXPECT_THROW(require_usable(volume), InvalidInput);  // NOLINT(bugprone-use-after-move)
  EXPECT_NO_THROW(require_usable(taken));
  Volume other = rising_volume();
  volume = std::move(other);
  EXPECT_NO_THROW(require_usable(volume));
  EXPECT_EQ(other.lattice().count(), 0u);  // NOLINT(bugprone-use-after-move)
}

Sites two_sites() {
  return {.positions = {Vec3f(0.0f), Vec3f(3.0f)}, .isovalues = {1.0f, 2.0f}, .normals = {Vec3f(0.0f), Vec3f(1.0f)}};
}

TEST(Misuse, SitesThatNoTracerTakesAreNamed) {
  const Lattice box = rising_volume().lattice();
  EXPECT_NO_THROW(require_usable(two_sites(), box, "sampler mine"));
  const auto error = [&](auto spoil) -> std::string {
    Sites sites = two_sites();
    spoil(sites);
    try {
      require_usable(sites, box, "sampler mine");
    } catch (const InvalidInput& what) {
      return what.what();
    }
    return "";
  };
  EXPECT_EQ(error([](Sites& s) { s.positions[1].y = 3.5f; }),
            "sampler mine: site 1 at (3, 3.5, 3) is not in the box, (0, 0, 0) to (3, 3, 3)");
  EXPECT_NE(error([](Sites& s) { s.positions[0].z = -0.001f; }), "");
  EXPECT_NE(error([](Sites& s) { s.positions[0].x = float(kNotANumber); }), "");
  EXPECT_NE(error([](Sites& s) { s.positions[0].x = INFINITY; }), "");
  EXPECT_EQ(error([](Sites& s) { s.isovalues[0] = INFINITY; }),
            "sampler mine: site 0 at (0, 0, 0) has isovalue inf: it must be finite");
  EXPECT_NE(error([](Sites& s) { s.normals[1].y = float(kNotANumber); }), "");
  EXPECT_NE(error([](Sites& s) { s.normals.pop_back(); }), "");
  EXPECT_NE(error([](Sites& s) { s.isovalues.push_back(0.0f); }), "");
}

TEST(Misuse, NumbersThatNoSiteHasAreRefused) {
  const std::vector<std::size_t> second{1};
  const std::vector<std::size_t> third{2};
  EXPECT_EQ(some_of(two_sites(), second).isovalues, std::vector<float>{2.0f});
  EXPECT_THROW((void)some_of(two_sites(), third), InvalidInput);
  Sites without_normals = two_sites();
  without_normals.normals.clear();
  EXPECT_THROW((void)some_of(without_normals, second), InvalidInput);
}

TEST(Misuse, AFieldOfATemporaryDoesNotCompile) {
  EXPECT_TRUE((std::is_constructible_v<TrilinearField, const Volume&>));
  EXPECT_FALSE((std::is_constructible_v<TrilinearField, Volume>));
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
  try {
    static_cast<void>(Registry<Stage>().create("first"));
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_EQ(std::string(error.what()), "no stage is called 'first'; there are none at all");
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
