#include "plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

namespace isolux::bench {
namespace {

constexpr double kLeft = 82, kTop = 46, kWidth = 520, kHeight = 350, kLegend = 26, kBottom = 62;
constexpr std::array<std::string_view, 9> kColours{"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00",
                                                   "#56B4E9", "#000000", "#8C510A", "#777777"};

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '&') {
      out += "&amp;";
    } else {
      out += c;
    }
  }
  return out;
}

bool shown(double v, Axis axis) { return std::isfinite(v) && (axis == Axis::kLinear || v > 0.0); }

/// From values to pixels, and the ticks between.
class Scale {
 public:
  Scale(Axis axis, double low, double high, double first_pixel, double last_pixel)
      : axis_(axis), first_(first_pixel), last_(last_pixel) {
    if (!(low <= high)) low = high = axis == Axis::kLog ? 1.0 : 0.0;
    low_ = axis == Axis::kLog ? std::log10(low) : low;
    high_ = axis == Axis::kLog ? std::log10(high) : high;
    const double margin = std::max(0.05 * (high_ - low_), axis == Axis::kLog ? 0.06 : 1e-9 * (1.0 + std::fabs(high_)));
    low_ -= margin;
    high_ += margin;
  }
  [[nodiscard]] double pixel(double v) const {
    const double at = axis_ == Axis::kLog ? std::log10(v) : v;
    return first_ + (at - low_) / (high_ - low_) * (last_ - first_);
  }
  [[nodiscard]] double clamped_pixel(double v) const {
    if (axis_ == Axis::kLog && !(v > 0.0)) return first_;
    return std::clamp(pixel(v), std::min(first_, last_), std::max(first_, last_));
  }
  /// Values that get a line and a number.
  [[nodiscard]] std::vector<double> ticks() const {
    if (axis_ == Axis::kLinear) return rounds(low_, high_);
    // Within so little of a decade its usual parts would leave one number or none.
    return high_ - low_ < 0.5 ? rounds(std::pow(10.0, low_), std::pow(10.0, high_)) : decades();
  }

 private:
  [[nodiscard]] std::vector<double> decades() const {
    std::vector<double> values;
    const double span = high_ - low_;
    // A decade each, within few decades also 2 and 5 times it, within one still more; many decades skip some.
    const int stride = std::max(1, int(std::ceil(span / 9.0)));
    for (int d = int(std::floor(low_)); d <= int(std::ceil(high_)); ++d) {
      if (d % stride != 0) continue;
      for (const double m : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0}) {
        const bool is_usual = m == 1.0 || m == 2.0 || m == 5.0;
        if ((m > 1.0 && span > 3.0) || (!is_usual && span > 1.0)) continue;
        const double at = double(d) + std::log10(m);
        if (at >= low_ && at <= high_) values.push_back(std::pow(10.0, d) * m);
      }
    }
    return values;
  }
  [[nodiscard]] static std::vector<double> rounds(double low, double high) {
    const double raw = (high - low) / 6.0;
    const double power = std::pow(10.0, std::floor(std::log10(raw)));
    double step = 10.0 * power;
    for (const double m : {1.0, 2.0, 5.0}) {
      if (m * power >= raw) {
        step = m * power;
        break;
      }
    }
    std::vector<double> values;
    for (double n = std::ceil(low / step); n * step <= high; n += 1.0) values.push_back(n * step + 0.0);  // no -0
    return values;
  }

  Axis axis_;
  double low_ = 0.0, high_ = 1.0, first_, last_;
};

std::string tick_text(double v) {
  const double size = std::fabs(v);
  if (v != 0.0 && (size >= 1e5 || size < 1e-3)) return fmt::format("{:.0e}", v);
  return fmt::format("{:.4g}", v);
}

/// One of six shapes about (x, y).
std::string mark(std::size_t shape, double x, double y, std::string_view colour) {
  switch (shape % 6) {
    case 0:
      return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3.6' fill='{}'/>\n", x, y, colour);
    case 1:
      return fmt::format("<rect x='{:.1f}' y='{:.1f}' width='6.6' height='6.6' fill='{}'/>\n", x - 3.3, y - 3.3,
                         colour);
    case 2:
      return fmt::format("<path d='M{:.1f} {:.1f}l4.4 7.6h-8.8z' fill='{}'/>\n", x, y - 4.8, colour);
    case 3:
      return fmt::format("<path d='M{:.1f} {:.1f}l4.8 4.8l-4.8 4.8l-4.8 -4.8z' fill='{}'/>\n", x, y - 4.8, colour);
    case 4:
      return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3.4' fill='white' stroke='{}' stroke-width='1.8'/>\n", x,
                         y, colour);
    default:
      return fmt::format("<path d='M{:.1f} {:.1f}l7 7m0 -7l-7 7' stroke='{}' stroke-width='2'/>\n", x - 3.5, y - 3.5,
                         colour);
  }
}

struct Frame {
  Scale x;
  Scale y;
};

Frame frame_of(const Plot& plot) {
  double x_low = std::numeric_limits<double>::infinity(), x_high = -x_low, y_low = x_low, y_high = -x_low;
  for (const Series& series : plot.series) {
    for (const PlotPoint& p : series.points) {
      if (!shown(p.x, plot.x_axis) || !shown(p.y, plot.y_axis)) continue;
      x_low = std::min(x_low, shown(p.left, plot.x_axis) ? p.left : p.x);
      x_high = std::max(x_high, shown(p.right, plot.x_axis) ? p.right : p.x);
      y_low = std::min(y_low, shown(p.low, plot.y_axis) ? std::max(p.low, 0.3 * p.y) : p.y);
      y_high = std::max(y_high, shown(p.high, plot.y_axis) ? p.high : p.y);
    }
  }
  return {.x = Scale(plot.x_axis, x_low, x_high, kLeft, kLeft + kWidth),
          .y = Scale(plot.y_axis, y_low, y_high, kTop + kHeight, kTop)};
}

std::string axes(const Plot& plot, const Frame& frame) {
  std::string out;
  for (const double v : frame.x.ticks()) {
    const double x = frame.x.pixel(v);
    out += fmt::format(
        "<path d='M{0:.1f} {1}V{2}' stroke='#dddddd'/><text x='{0:.1f}' y='{3}' text-anchor='middle'>{4}</text>\n", x,
        kTop, kTop + kHeight, kTop + kHeight + 18, tick_text(v));
  }
  for (const double v : frame.y.ticks()) {
    const double y = frame.y.pixel(v);
    out += fmt::format(
        "<path d='M{0} {1:.1f}H{2}' stroke='#dddddd'/><text x='{3}' y='{4:.1f}' text-anchor='end'>{5}</text>\n", kLeft,
        y, kLeft + kWidth, kLeft - 7, y + 4, tick_text(v));
  }
  out += fmt::format("<rect x='{}' y='{}' width='{}' height='{}' fill='none' stroke='#444444'/>\n", kLeft, kTop, kWidth,
                     kHeight);
  out += fmt::format("<text x='{}' y='24' font-size='16' font-weight='bold'>{}</text>\n", kLeft, escaped(plot.title));
  out += fmt::format("<text x='{}' y='{}' text-anchor='middle'>{}</text>\n", kLeft + kWidth / 2, kTop + kHeight + 42,
                     escaped(plot.x_label));
  out += fmt::format("<text transform='translate(20 {}) rotate(-90)' text-anchor='middle'>{}</text>\n",
                     kTop + kHeight / 2, escaped(plot.y_label));
  return out;
}

/// Past the palette's end curves are dashed, so that no two look alike.
std::string_view dashes(std::size_t number) { return number < kColours.size() ? "" : " stroke-dasharray='6 3'"; }

std::string curve(const Plot& plot, const Frame& frame, const Series& series, std::size_t number) {
  const std::string_view colour = kColours[number % kColours.size()];
  std::string line;
  std::string marks;
  for (const PlotPoint& p : series.points) {
    if (!shown(p.x, plot.x_axis) || !shown(p.y, plot.y_axis)) continue;
    const double x = frame.x.pixel(p.x);
    const double y = frame.y.pixel(p.y);
    if (series.stroke == Stroke::kLine) line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", x, y);
    if (std::isfinite(p.left) && std::isfinite(p.right)) {
      marks += fmt::format("<path d='M{:.1f} {:.1f}H{:.1f}' stroke='{}' fill='none'/>\n", frame.x.clamped_pixel(p.left),
                           y, frame.x.clamped_pixel(p.right), colour);
    }
    if (std::isfinite(p.low) && std::isfinite(p.high)) {
      marks += fmt::format("<path d='M{0:.1f} {1:.1f}V{2:.1f}m-3 0h6M{3:.1f} {1:.1f}h6' stroke='{4}' fill='none'/>\n",
                           x, frame.y.clamped_pixel(p.low), frame.y.clamped_pixel(p.high), x - 3, colour);
    }
    marks += mark(number, x, y, colour);
  }
  if (line.empty()) return marks;
  return fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='1.6'{}/>\n{}", line, colour, dashes(number),
                     marks);
}

}  // namespace

std::string svg(const Plot& plot) {
  const Frame frame = frame_of(plot);
  std::string body = axes(plot, frame);
  double legend_y = kTop + 10;
  std::size_t longest = 0;
  std::size_t number = 0;
  for (const Series& series : plot.series) {
    if (series.points.empty()) continue;
    body += curve(plot, frame, series, number);
    body += mark(number, kLeft + kWidth + kLegend, legend_y, kColours[number % kColours.size()]);
    body += fmt::format("<text x='{}' y='{}'>{}</text>\n", kLeft + kWidth + kLegend + 12, legend_y + 4,
                        escaped(series.name));
    longest = std::max(longest, series.name.size());
    legend_y += 20;
    ++number;
  }
  const double width = kLeft + kWidth + kLegend + 24 + 7.0 * double(longest);
  const double height = std::max(kTop + kHeight + kBottom, legend_y + 10);
  return fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{0:.0f}' height='{1:.0f}' viewBox='0 0 {0:.0f} {1:.0f}' "
      "font-family='DejaVu Sans, Verdana, sans-serif' font-size='12.5' fill='#222222'>\n"
      "<rect width='100%' height='100%' fill='white'/>\n{2}</svg>\n",
      width, height, body);
}

}  // namespace isolux::bench
