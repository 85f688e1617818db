// What the fuzz targets share. A law that does not hold ends the program, and libFuzzer keeps the input.
#pragma once

#include <isolux/core/error.h>
#include <isolux/core/run.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace isolux::fuzz {

inline void require(bool holds, const std::string& law) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", law.c_str());
  std::abort();
}

/// Whether `work` ends in an isolux::Error, as all that is wrong with an input has to, in one line.
template <class Work>
[[nodiscard]] bool refused(const Work& work) {
  try {
    work();
    return false;
  } catch (const Error& error) {
    const std::string_view what = error.what();
    require(!what.empty() && what.find('\n') == std::string_view::npos, "an error is one line: " + std::string(what));
    return true;
  }
}

/// One thread: a finding is found again.
inline Run alone() {
  Run run;
  run.threads = 1;
  return run;
}

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// An input as numbers, one after the other; behind its end are zeros.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : left_(data, size) {}

  /// Any bits.
  template <class T>
  [[nodiscard]] T next() {
    T value{};
    const std::size_t count = std::min(sizeof(T), left_.size());
    std::memcpy(&value, left_.data(), count);
    left_ = left_.subspan(count);
    return value;
  }
  /// 0 to count - 1; up to 256 are equally likely.
  [[nodiscard]] int below(int count) { return int(next<std::uint8_t>()) % count; }

 private:
  std::span<const std::uint8_t> left_;
};

}  // namespace isolux::fuzz
