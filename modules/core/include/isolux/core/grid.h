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

/// The owning grid.
template <class T>
class Grid {
 public:
  Grid() = default;
  explicit Grid(const Lattice& lattice, T value = T{}) : lattice_(lattice), values_(lattice.count(), value) {}
  /// \throw InvalidInput unless there is one value a point
  Grid(const Lattice& lattice, std::vector<T> values) : lattice_(lattice), values_(std::move(values)) {
    require_values(lattice, values_.size());
  }
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
