#pragma once

#include <isolux/core/lattice.h>

#include <span>
#include <utility>
#include <vector>

namespace isolux {

/// A lattice with one value a point, x fastest; looks at memory it does not own.
template <class T>
class GridView {
 public:
  GridView() = default;
  /// \throw InvalidInput unless there is one value a point
  GridView(const Lattice& lattice, std::span<T> values) : lattice_(lattice), values_(values) {
    require_values(lattice, values.size());
  }
  [[nodiscard]] const Lattice& lattice() const { return lattice_; }
  [[nodiscard]] Index3 size() const { return lattice_.size; }
  [[nodiscard]] std::span<T> values() const { return values_; }
  [[nodiscard]] T& operator()(int i, int j, int k) const { return values_[lattice_.offset(i, j, k)]; }

 private:
  Lattice lattice_;
  std::span<T> values_;
};

/// The owning grid. What it is moved out of has no points.
template <class T>
class Grid {
 public:
  Grid() = default;
  /// \throw InvalidInput for sizes below 0 and more points than memory can be asked for
  explicit Grid(const Lattice& lattice, T value = T{})
      : lattice_(lattice), values_(require_countable(lattice), value) {}
  /// \throw InvalidInput unless there is one value a point
  Grid(const Lattice& lattice, std::vector<T> values) : lattice_(lattice), values_(std::move(values)) {
    require_values(lattice, values_.size());
  }
  Grid(const Grid&) = default;
  Grid& operator=(const Grid&) = default;
  Grid(Grid&& other) noexcept
      : lattice_(std::exchange(other.lattice_, {})), values_(std::exchange(other.values_, {})) {}
  Grid& operator=(Grid&& other) noexcept {
    lattice_ = std::exchange(other.lattice_, {});
    values_ = std::exchange(other.values_, {});
    return *this;
  }
  ~Grid() = default;

  [[nodiscard]] const Lattice& lattice() const { return lattice_; }
  [[nodiscard]] Index3 size() const { return lattice_.size; }
  [[nodiscard]] std::span<T> values() { return values_; }
  [[nodiscard]] std::span<const T> values() const { return values_; }
  [[nodiscard]] T& operator()(int i, int j, int k) { return values_[lattice_.offset(i, j, k)]; }
  [[nodiscard]] const T& operator()(int i, int j, int k) const { return values_[lattice_.offset(i, j, k)]; }
  [[nodiscard]] GridView<const T> view() const { return {lattice_, values_}; }

 private:
  Lattice lattice_;
  std::vector<T> values_;
};

}  // namespace isolux
