#pragma once

#include <string>

#include "ui/box.h"

namespace isolux::viewer {

/// A horizontal slider: a track between two values and a knob. No drawing: see draw_slider().
class Slider {
 public:
  /// \pre low <= high
  Slider(double low, double high, double value);

  /// Where the track lies. The knob is taken anywhere in the box.
  void place(const Box& track) { track_ = track; }
  [[nodiscard]] const Box& track() const { return track_; }

  [[nodiscard]] double value() const { return value_; }
  /// The value in words, with digits enough to tell it from that a step of 1/500 further, at most those of a float.
  [[nodiscard]] std::string text() const;
  /// The nearest there is.
  void set_value(double value);
  /// Moves by a part of the whole range: .01 is one percent up.
  void step(double part);

  [[nodiscard]] double low() const { return low_; }
  [[nodiscard]] double high() const { return high_; }

  /// x of the knob's middle, and the value there.
  [[nodiscard]] double position() const;
  [[nodiscard]] double value_at(double x) const;

  /// The mouse goes down: false if it is elsewhere. On the knob the knob stays under the mouse as it was taken,
  /// elsewhere on the track it jumps there.
  [[nodiscard]] bool press(double x, double y);
  /// The mouse moves, anywhere, with the button down: does nothing unless press() took it.
  void drag(double x);
  void release() { held_ = false; }
  [[nodiscard]] bool held() const { return held_; }

  static constexpr double kKnobWidth = 12.0;

 private:
  double low_;
  double high_;
  double value_;
  Box track_;
  bool held_ = false;
  double grip_ = 0.0;  ///< from the mouse to the knob's middle while held
};

}  // namespace isolux::viewer
