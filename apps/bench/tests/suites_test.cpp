#include "suite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "faults.h"
#include "report.h"
#include "tracer_laws.h"

namespace isolux::bench {
namespace {

namespace fs = std::filesystem;

SuiteContext smoke() {
  return {.effort = Effort::kSmoke,
          .run = {.seed = 1, .threads = 2},
          .stages = builtin_stages(),
          .data_folder = {},
          .say = [](std::string_view) {}};
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Every element that is opened is closed, in order: enough to see that a picture is not cut or mixed up.
bool is_balanced(const std::string& svg) {
  std::vector<std::string> open;
  for (std::size_t at = svg.find('<'); at != std::string::npos; at = svg.find('<', at + 1)) {
    const std::size_t end = svg.find('>', at);
    if (end == std::string::npos) return false;
    const std::string name = svg.substr(at + 1, svg.find_first_of(" />", at + 2) - at - 1);
    if (svg[end - 1] == '/') continue;
    if (svg[at + 1] != '/') {
      open.push_back(name);
    } else if (open.empty() || "/" + open.back() != svg.substr(at + 1, end - at - 1)) {
      return false;
    } else {
      open.pop_back();
    }
  }
  return open.empty();
}

class EverySuite : public testing::TestWithParam<std::string> {};

TEST_P(EverySuite, WritesValidJsonCsvAndSvg) {
  const auto suite =
      std::find_if(suites().begin(), suites().end(), [](const Suite& s) { return s.name == GetParam(); });
  const fs::path folder = fs::path(testing::TempDir()) / ("isolux_bench_" + GetParam());
  fs::remove_all(folder);
  SuiteContext context = smoke();
  context.budget = budget_of(*suite, context.effort);
  const SuiteReport report = suite->run(context);
  write_suite(folder, *suite, report, context, 1.0);
  write_report(folder, context);

  const auto json = nlohmann::json::parse(text_of(folder / (GetParam() + ".json")));
  EXPECT_EQ(json.at("effort"), "smoke");
  EXPECT_FALSE(json.at("highlights").empty());
  // The laws hold, and no fault goes unseen: sizes are small, but none of it is a matter of chance with a fixed seed.
  EXPECT_THAT(report.failures, testing::IsEmpty());
  EXPECT_EQ(json.at("figures").size(), report.figures.size());
  for (const auto& figure : json.at("figures")) {
    const std::string id = figure.at("id");
    const std::string stem = GetParam() + "-" + id;
    EXPECT_FALSE(figure.at("sentence").get<std::string>().empty()) << id;
    const std::string csv = text_of(folder / (stem + ".csv"));
    const auto lines = std::size_t(std::count(csv.begin(), csv.end(), '\n'));
    EXPECT_EQ(lines, figure.at("rows").size() + 1) << id;
    if (figure.at("kind") != "plot") continue;
    const std::string svg = text_of(folder / (stem + ".svg"));
    EXPECT_TRUE(is_balanced(svg)) << id;
    EXPECT_THAT(svg, testing::Not(testing::HasSubstr("nan"))) << id;
  }
  EXPECT_THAT(text_of(folder / "report.md"), testing::HasSubstr("## In brief"));
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Bench, EverySuite, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const Suite& suite : suites()) names.emplace_back(suite.name);
                           return names;
                         }()),
                         [](const auto& test) { return test.param; });

class EveryFault : public testing::TestWithParam<std::string> {};

TEST_P(EveryFault, FailsALaw) {
  SuiteContext context = smoke();
  context.stages = with_fault(std::move(context.stages), GetParam());
  Judge judge;
  try_laws(GetParam(), context, 0.1, judge);
  EXPECT_THAT(judge.failures(), testing::Not(testing::IsEmpty()));
}

INSTANTIATE_TEST_SUITE_P(Bench, EveryFault, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const Fault& fault : faults()) names.emplace_back(fault.name);
                           return names;
                         }()),
                         [](const auto& test) { return test.param; });

TEST(Faults, RefusesAnUnknownName) { EXPECT_THROW((void)with_fault(builtin_stages(), "no_light"), InvalidInput); }

TEST(Climb, TakesTheFirstStepAlwaysAndLaterOnesWhileTheyFit) {
  Climb none(0.0, 4.0);
  EXPECT_TRUE(none.goes_on());
  EXPECT_FALSE(none.goes_on());
  Climb plenty(1e6, 4.0);
  EXPECT_TRUE(plenty.goes_on());
  EXPECT_TRUE(plenty.goes_on());
}

}  // namespace
}  // namespace isolux::bench
