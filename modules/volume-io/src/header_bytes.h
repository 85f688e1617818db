#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <utility>

namespace isolux::detail {

/// Numbers at fixed places of a binary header. \pre every place asked for lies inside the bytes
class HeaderBytes {
 public:
  HeaderBytes(std::string bytes, bool big_endian) : bytes_(std::move(bytes)), big_endian_(big_endian) {}

  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] bool big_endian() const { return big_endian_; }

  template <class T>
  [[nodiscard]] T get(std::size_t offset) const {
    std::array<char, sizeof(T)> raw;
    std::copy_n(bytes_.begin() + std::ptrdiff_t(offset), sizeof(T), raw.begin());
    if (big_endian_) std::reverse(raw.begin(), raw.end());
    T value;
    std::memcpy(&value, raw.data(), sizeof(T));
    return value;
  }

 private:
  std::string bytes_;
  bool big_endian_;
};

}  // namespace isolux::detail
