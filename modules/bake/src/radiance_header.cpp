#include "radiance_header.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <string_view>
#include <vector>

namespace isolux {
namespace {

constexpr std::size_t kLongestHeader = std::size_t(1) << 20;

/// Of a header that may hold anything: short, on one line.
std::string shown(std::string_view line) {
  std::string text(line.substr(0, 60));
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

/// The numbers parted by blanks; none at all if anything else stands there.
std::vector<double> numbers_of(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  std::vector<double> numbers;
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    if (text.empty()) return numbers;
    const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
    const char* const end = word.data() + word.size();
    double number = 0.0;
    const auto [stop, error] = std::from_chars(word.data() + (word.front() == '+' ? 1 : 0), end, number);
    if (error != std::errc{} || stop != end) return {};
    numbers.push_back(number);
    text.remove_prefix(word.size());
  }
}

bool is_factor(double number) { return std::isfinite(number) && number > 0.0; }

Vec3 factors(const std::string& path, std::string_view line, std::size_t count) {
  const std::vector<double> numbers = numbers_of(line.substr(line.find('=') + 1));
  if (numbers.size() != count || !is_factor(numbers.front()) || !is_factor(numbers[count / 2]) ||
      !is_factor(numbers.back()))
    throw InvalidInput(fmt::format("{}: '{}' in the header; {} wanted", path, shown(line),
                                   count == 1 ? "a finite number above 0 is" : "three finite numbers above 0 are"));
  return {numbers.front(), numbers[count / 2], numbers.back()};
}

}  // namespace

Vec3 radiance_exposure(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(kLongestHeader, '\0');
  file.read(head.data(), std::streamsize(head.size()));
  head.resize(std::size_t(file.gcount()));
  Vec3 exposure(1.0);
  std::string_view rest = head;
  const auto next_line = [&] {
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos && head.size() < kLongestHeader)
      throw IoError(path + ": the image ends early, in its header");
    if (end == std::string_view::npos)
      throw InvalidInput(fmt::format("{}: the header does not end within {} bytes", path, kLongestHeader));
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    return line;
  };
  for (;;) {
    const std::string_view line = next_line();
    if (line.empty() || line.front() == '\0') break;
    // Lines that are indented tell of the pictures that this one was made from.
    if (line.starts_with("EXPOSURE=")) exposure *= factors(path, line, 1);
    if (line.starts_with("COLORCORR=")) exposure *= factors(path, line, 3);
    if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
      throw InvalidInput(fmt::format("{}: '{}' in the header; 32-bit_rle_rgbe is read", path, shown(line)));
  }
  if (!is_factor(exposure.x) || !is_factor(exposure.y) || !is_factor(exposure.z))
    throw InvalidInput(path + ": the header's exposures multiplied are no finite number above 0");
  const std::string_view order = next_line();
  if (!(order.starts_with("-Y ") && order.find(" +X ") != std::string_view::npos))
    throw InvalidInput(fmt::format("{}: rows ordered as '{}'; '-Y height +X width' is read", path, shown(order)));
  return exposure;
}

}  // namespace isolux
