#pragma once

#include <limits>
#include <string>
#include <variant>
#include <vector>

namespace isolux::bench {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A point of a curve; low and high are the ends of its error bar, kNone where it has none.
struct PlotPoint {
  double x = 0.0;
  double y = 0.0;
  double low = kNone;
  double high = kNone;
  double left = kNone;  ///< the same along x
  double right = kNone;
};

enum class Stroke { kLine, kMarks };

struct Series {
  std::string name;
  std::vector<PlotPoint> points{};
  Stroke stroke = Stroke::kLine;  ///< kMarks where points are no steps of one thing
};

enum class Axis { kLog, kLinear };

/// A picture of curves, and the sentence that says what it shows.
struct Plot {
  std::string id;  ///< file name stem within its suite
  std::string title;
  std::string x_label;
  std::string y_label;
  Axis x_axis = Axis::kLog;
  Axis y_axis = Axis::kLog;
  std::vector<Series> series{};
  std::string sentence{};
};

using Cell = std::variant<std::string, double>;

/// Figures in rows, and the sentence that says what they show.
struct Table {
  std::string id;
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows{};
  std::string sentence{};
};

/// What a suite found, in reading order.
struct SuiteReport {
  std::vector<std::variant<Table, Plot>> figures;
  std::vector<std::string> failures{};    ///< claims that did not hold; empty if all is well
  std::vector<std::string> highlights{};  ///< what to know of it, a sentence each, figures included
};

/// A number as the report prints it: four significant digits; an empty text for kNone.
[[nodiscard]] std::string number_text(double value);

}  // namespace isolux::bench
