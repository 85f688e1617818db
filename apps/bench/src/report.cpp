#include "report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "plot.h"

namespace isolux::bench {
namespace {

namespace fs = std::filesystem;

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.flush();
  if (!file) throw IoError(fmt::format("{}: cannot be written", path.string()));
}

std::string cell_text(const Cell& cell) {
  const auto* words = std::get_if<std::string>(&cell);
  return words != nullptr ? *words : number_text(std::get<double>(cell));
}

std::string csv_cell(const Cell& cell) {
  const auto* words = std::get_if<std::string>(&cell);
  if (words == nullptr) {
    const double v = std::get<double>(cell);
    return std::isfinite(v) ? fmt::format("{}", v) : "";
  }
  if (words->find_first_of(",\"") == std::string::npos) return *words;
  std::string quoted = "\"";
  for (const char c : *words) {
    quoted += c;
    if (c == '"') quoted += c;
  }
  return quoted + '"';
}

/// A plot's points as the table that its CSV file holds.
Table points_of(const Plot& plot) {
  Table table{.id = plot.id, .title = plot.title, .columns = {"series", plot.x_label, plot.y_label, "low", "high"}};
  for (const Series& series : plot.series) {
    for (const PlotPoint& p : series.points) table.rows.push_back({series.name, p.x, p.y, p.low, p.high});
  }
  return table;
}

std::string csv(const Table& table) {
  std::string text;
  const auto line = [&](const std::vector<Cell>& cells) {
    std::vector<std::string> words;
    for (const Cell& cell : cells) words.push_back(csv_cell(cell));
    text += fmt::format("{}\n", fmt::join(words, ","));
  };
  line({table.columns.begin(), table.columns.end()});
  for (const auto& row : table.rows) line(row);
  return text;
}

nlohmann::json json(const Table& table, const std::string& kind, const std::string& sentence) {
  nlohmann::json rows = nlohmann::json::array();
  for (const auto& row : table.rows) {
    nlohmann::json cells = nlohmann::json::array();
    for (const Cell& cell : row) {
      std::visit([&](const auto& value) { cells.push_back(value); }, cell);
    }
    rows.push_back(std::move(cells));
  }
  return {{"kind", kind}, {"id", table.id},           {"title", table.title},
          {"rows", rows}, {"columns", table.columns}, {"sentence", sentence}};
}

std::string markdown(const Table& table) {
  std::string text = fmt::format("| {} |\n|", fmt::join(table.columns, " | "));
  for (std::size_t i = 0; i < table.columns.size(); ++i) text += " --- |";
  text += '\n';
  for (const auto& row : table.rows) {
    std::vector<std::string> words;
    for (const Cell& cell : row) words.push_back(cell_text(cell));
    text += fmt::format("| {} |\n", fmt::join(words, " | "));
  }
  return text;
}

/// Figures of an earlier run, of which this one may have others.
void remove_figures(const fs::path& folder, const Suite& suite) {
  const std::string stem = fmt::format("{}-", suite.name);
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const std::string extension = entry.path().extension().string();
    if (name.rfind(stem, 0) == 0 && (extension == ".csv" || extension == ".svg")) old.push_back(entry.path());
  }
  for (const fs::path& path : old) fs::remove(path);
}

/// Title, verdict and highlights of a suite that has run, from its JSON file; "" if it has not.
std::string summary(const fs::path& folder, const Suite& suite) {
  std::ifstream file(folder / fmt::format("{}.json", suite.name), std::ios::binary);
  if (!file) return {};
  const nlohmann::json all = nlohmann::json::parse(file);
  std::string text = fmt::format("- **{}**", suite.title);
  if (!all.at("failures").empty()) text += fmt::format(" ({} FAILED)", all.at("failures").size());
  for (const auto& sentence : all.at("highlights")) text += "\n  - " + sentence.get<std::string>();
  return text + "\n";
}

}  // namespace

std::string number_text(double value) {
  if (std::isnan(value)) return "";
  if (value == std::round(value) && std::fabs(value) < 1e7) return fmt::format("{:.0f}", value);
  return fmt::format("{:.4g}", value);
}

void write_suite(const fs::path& folder, const Suite& suite, const SuiteReport& report, const SuiteContext& context,
                 double seconds) {
  fs::create_directories(folder);
  remove_figures(folder, suite);
  nlohmann::json all{{"suite", std::string(suite.name)},
                     {"effort", std::string(effort_name(context.effort))},
                     {"seed", context.run.seed},
                     {"threads", thread_count(context.run)},
                     {"seconds", seconds},
                     {"failures", report.failures},
                     {"highlights", report.highlights},
                     {"figures", nlohmann::json::array()}};
  std::string text = fmt::format("## {}\n\n{}. Suite `{}`, {} run of {:.0f} s.\n\n", suite.title, suite.help,
                                 suite.name, effort_name(context.effort), seconds);
  for (const std::string& failure : report.failures) text += fmt::format("**Failed:** {}\n\n", failure);
  for (const auto& figure : report.figures) {
    const auto* plot = std::get_if<Plot>(&figure);
    const Table table = plot != nullptr ? points_of(*plot) : std::get<Table>(figure);
    const std::string& sentence = plot != nullptr ? plot->sentence : table.sentence;
    const std::string stem = fmt::format("{}-{}", suite.name, table.id);
    write_text(folder / (stem + ".csv"), csv(table));
    all["figures"].push_back(json(table, plot != nullptr ? "plot" : "table", sentence));
    text += fmt::format("### {}\n\n{}\n\n", table.title, sentence);
    if (plot != nullptr) {
      write_text(folder / (stem + ".svg"), svg(*plot));
      text += fmt::format("![{}]({}.svg)\n\n", plot->title, stem);
    } else {
      text += markdown(table) + "\n";
    }
  }
  write_text(folder / fmt::format("{}.json", suite.name), all.dump(1) + "\n");
  write_text(folder / fmt::format("{}.md", suite.name), text);
}

void write_report(const fs::path& folder, const SuiteContext& context) {
  std::string text =
      "# Run time against error\n\nWritten by `isolux bench`, figures and sentences alike. Every picture is drawn from "
      "the CSV file of its name; all figures of a suite are in its JSON file.\n\n";
  text += machine_description(context) + "\n## In brief\n\n";
  for (const Suite& suite : suites()) text += summary(folder, suite);
  text += "\n";
  for (const Suite& suite : suites()) {
    std::ifstream file(folder / fmt::format("{}.md", suite.name), std::ios::binary);
    if (file) text.append(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  write_text(folder / "report.md", text);
}

}  // namespace isolux::bench
