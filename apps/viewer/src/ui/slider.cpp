#include "ui/slider.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isolux::viewer {

Slider::Slider(double low, double high, double value) : low_(low), high_(high), value_(std::clamp(value, low, high)) {}

void Slider::set_value(double value) { value_ = std::clamp(value, low_, high_); }

void Slider::step(double part) { set_value(value_ + part * (high_ - low_)); }

std::string Slider::text() const {
  const double largest = std::max(std::fabs(low_), std::fabs(high_));
  const double step = (high_ - low_) / 500.0;
  const int digits = step > 0.0 ? int(std::ceil(std::log10(largest / step))) + 1 : 0;
  return fmt::format("{:.{}g}", value_, std::clamp(digits, 5, 9));
}

double Slider::position() const {
  const double part = high_ > low_ ? (value_ - low_) / (high_ - low_) : 0.5;
  return track_.x + part * track_.width;
}

double Slider::value_at(double x) const {
  const double part = track_.width > 0.0 ? (x - track_.x) / track_.width : 0.0;
  return low_ + std::clamp(part, 0.0, 1.0) * (high_ - low_);
}

bool Slider::press(double x, double y) {
  const Box with_knob{track_.x - kKnobWidth / 2.0, track_.y, track_.width + kKnobWidth, track_.height};
  if (!with_knob.contains(x, y)) return false;
  held_ = true;
  grip_ = position() - x;
  if (std::fabs(grip_) > kKnobWidth / 2.0) {
    grip_ = 0.0;
    drag(x);
  }
  return true;
}

void Slider::drag(double x) {
  if (held_) value_ = value_at(x + grip_);
}

}  // namespace isolux::viewer
