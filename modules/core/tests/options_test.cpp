#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/core/registry.h>

namespace isolux {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class Stage {
 public:
  static constexpr std::string_view kStage = "filter";
  virtual ~Stage() = default;
  [[nodiscard]] virtual double answer() const = 0;
};

enum class Flavour { kSweet, kSour };

class Mixer : public Stage {
 public:
  struct Options {
    int count = 3;
    double weight = 0.5;
    bool loud = false;
    Flavour flavour = Flavour::kSweet;
    std::string label = "none";

    void describe(OptionVisitor& option) {
      option("count", count, {.min = 1, .max = 10, .unit = "items", .help = "how many"});
      option("weight", weight, {.min = 0, .help = "how heavy"});
      option("loud", loud, {.help = "whether"});
      option("flavour", flavour, {{"sweet", Flavour::kSweet}, {"sour", Flavour::kSour}}, {.help = "which"});
      option("label", label, {.help = "what it is called"});
    }
  };
  explicit Mixer(const Options& options) : options_(options) {}
  [[nodiscard]] double answer() const override {
    return options_.count + options_.weight + (options_.loud ? 100 : 0) +
           (options_.flavour == Flavour::kSour ? 1000 : 0) + (options_.label == "a = b" ? 5000 : 0);
  }

 private:
  Options options_;
};

class Plain : public Stage {
 public:
  using Options = NoOptions;
  explicit Plain(const Options& /*options*/) {}
  [[nodiscard]] double answer() const override { return -1; }
};

Registry<Stage> registry() {
  Registry<Stage> r;
  r.add<Mixer>("mixer", "mixes");
  r.add<Plain>("plain", "does not");
  r.add_unavailable("fancy", "package Fancy was not found");
  r.set_default("plain");
  return r;
}

TEST(Registry, MakesBackendsWithTheirDefaultsAndSettings) {
  EXPECT_EQ(registry().create("mixer")->answer(), 3.5);
  EXPECT_EQ(
      registry().create("mixer", {{"count", "7"}, {"weight", "0.25"}, {"loud", "true"}, {"flavour", "sour"}})->answer(),
      1107.25);
  EXPECT_EQ(registry().create()->answer(), -1);
}

TEST(Registry, TakesAnyTextAsItIs) {
  EXPECT_EQ(registry().create("mixer", {{"label", "a = b"}})->answer(), 5003.5);
  EXPECT_EQ(registry().create("mixer", {{"label", "a"}})->answer(), 3.5);
}

TEST(Registry, TakesNumbersWithASign) {
  EXPECT_EQ(registry().create("mixer", {{"count", "+7"}, {"weight", "+0.25"}})->answer(), 7.25);
  for (const char* text : {"+", "+-7", "++7", " +7"})
    EXPECT_THROW((void)registry().create("mixer", {{"count", text}}), InvalidInput) << text;
}

TEST(Registry, TakesWhatIsAtAnOptionsEnds) {
  EXPECT_EQ(registry().create("mixer", {{"count", "1"}, {"weight", "0"}})->answer(), 1.0);
  EXPECT_EQ(registry().create("mixer", {{"count", "10"}})->answer(), 10.5);
}

TEST(Registry, NamesWhatIsAllowedWhenABackendIsUnknown) {
  EXPECT_THAT([] { static_cast<void>(registry().create("mixr")); },
              ThrowsMessage<InvalidInput>(
                  testing::AllOf(HasSubstr("filter"), HasSubstr("did you mean 'mixer'"), HasSubstr("plain"))));
  EXPECT_THAT([] { static_cast<void>(registry().create("fancy")); },
              ThrowsMessage<InvalidInput>(HasSubstr("package Fancy was not found")));
}

TEST(Registry, RefusesASecondBackendOfOneName) {
  auto r = registry();
  EXPECT_THROW((r.add<Plain>("mixer", "again")), InvalidInput);
}

/// With the options of the test that is run.
class Named final : public Plain {
 public:
  struct Options {
    static std::vector<std::string>& names() {
      static std::vector<std::string> list;
      return list;
    }
    int value = 0;
    void describe(OptionVisitor& option) {
      for (const std::string& name : names()) option(name, value, {});
    }
  };
  explicit Named(const Options& /*options*/) : Plain({}) {}
};

// Else nobody could say them on a command line, or which of two is meant.
TEST(Registry, RefusesNamesThatCannotBeSaid) {
  auto r = registry();
  for (const std::string name : {"", "a b", "a.b", "a=b", "a\n", "\xC3\xBC", "a,b"}) {
    Named::Options::names() = {};
    EXPECT_THROW(r.add<Named>(name, ""), InvalidInput) << name;
    EXPECT_THROW(r.add_unavailable(name, "why"), InvalidInput) << name;
    Named::Options::names() = {"fine", name};
    EXPECT_THAT([&] { r.add<Named>("named", ""); },
                ThrowsMessage<InvalidInput>(HasSubstr("filter named: an option called '")));
  }
  Named::Options::names() = {"one", "two", "one"};
  EXPECT_THAT([&] { r.add<Named>("named", ""); },
              ThrowsMessage<InvalidInput>(HasSubstr("filter named: two options called 'one'")));
  EXPECT_EQ(r.backends().size(), 3u);
  Named::Options::names() = {"one", "Two_2", "3-d"};
  r.add<Named>("a_B-9", "");
  EXPECT_EQ(r.info("a_B-9").options.size(), 3u);
}

TEST(Registry, ListsOptionsWithRangesAndDefaults) {
  const Registry<Stage> r = registry();
  const BackendInfo& mixer = r.info("mixer");
  ASSERT_EQ(mixer.options.size(), 5U);
  EXPECT_EQ(mixer.options[0].allowed(), "a whole number from 1 to 10");
  EXPECT_EQ(mixer.options[1].allowed(), "a number of at least 0");
  EXPECT_EQ(mixer.options[2].default_value, "false");
  EXPECT_EQ(mixer.options[3].allowed(), "sweet | sour");
  EXPECT_EQ(mixer.options[4].allowed(), "any text");
  EXPECT_EQ(mixer.options[4].default_value, "none");
}

using Bad = std::tuple<std::string, std::string, std::string>;  // key, value, what the message says

class BadSetting : public testing::TestWithParam<Bad> {};

TEST_P(BadSetting, IsRefusedByName) {
  const auto& [key, value, said] = GetParam();
  const Settings settings{{key, value}};
  EXPECT_THAT([&] { static_cast<void>(registry().create("mixer", settings)); },
              ThrowsMessage<InvalidInput>(HasSubstr(said)));
}

INSTANTIATE_TEST_SUITE_P(Options, BadSetting,
                         testing::Values(Bad("count", "11", "from 1 to 10"), Bad("count", "0", "count = '0'"),
                                         Bad("count", "2.5", "whole number"), Bad("count", "", "whole number"),
                                         Bad("weight", "-1", "at least 0"), Bad("weight", "nan", "weight"),
                                         Bad("weight", "inf", "weight"), Bad("weight", "1e999", "weight"),
                                         Bad("loud", "yes", "true | false"), Bad("flavour", "bitter", "sweet | sour"),
                                         Bad("coutn", "3", "did you mean 'count'")));

TEST(NearestWord, FindsTyposAndNothingFarAway) {
  EXPECT_EQ(nearest_word("albdeo", {"albedo", "emission"}), "albedo");
  EXPECT_EQ(nearest_word("zzzzzz", {"albedo", "emission"}), "");
}

}  // namespace
}  // namespace isolux
