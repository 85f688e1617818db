#pragma once

#include <cstddef>
#include <vector>

namespace isolux {

/// Numbers of consecutive samples, of which the first are let go of as the last ones come.
template <class T>
class SampleWindow {
 public:
  /// From sample 0 on, so many numbers each, with memory for as many samples as are ever held together.
  explicit SampleWindow(std::size_t each = 1, std::size_t most = 0) : each_(each) { values_.reserve(most * each); }

  /// \pre that sample is held
  [[nodiscard]] T* of(std::size_t sample) { return &values_[(sample - first_) * each_]; }
  [[nodiscard]] const T* of(std::size_t sample) const { return &values_[(sample - first_) * each_]; }

  /// Those before `end` are held from here on, new ones being T{}. \pre end is no less than before
  void hold_until(std::size_t end) { values_.resize((end - first_) * each_); }
  /// \pre sample `first` is held, or is the next one
  void let_go_before(std::size_t first) {
    values_.erase(values_.begin(), values_.begin() + std::ptrdiff_t((first - first_) * each_));
    first_ = first;
  }

 private:
  std::size_t each_;
  std::size_t first_ = 0;
  std::vector<T> values_;
};

}  // namespace isolux
