#include "format_checks.h"
#include "plain_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace isolux::detail {
namespace {

// Runs of digits compare as numbers.
bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const auto number_end = [&](const std::string& text, std::size_t at) {
        while (at < text.size() && is_digit(text[at])) ++at;
        return at;
      };
      while (i < a.size() && a[i] == '0') ++i;
      while (j < b.size() && b[j] == '0') ++j;
      const std::size_t end_a = number_end(a, i);
      const std::size_t end_b = number_end(b, j);
      if (end_a - i != end_b - j) return end_a - i < end_b - j;
      const int order = a.compare(i, end_a - i, b, j, end_b - j);
      if (order != 0) return order < 0;
      i = end_a;
      j = end_b;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;
}

}  // namespace

std::vector<std::string> files_in_folder(const std::string& folder, bool (*is)(const std::string&)) {
  namespace fs = std::filesystem;
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string path = it->path().string();
    if (is(path)) files.push_back(path);
  }
  if (error) throw IoError(fmt::format("{}: {}", folder, error.message()));
  std::sort(files.begin(), files.end(), natural_less);
  return files;
}

void require_finite(const std::string& path, std::string_view what, std::span<const double> numbers) {
  if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
    throw InvalidInput(fmt::format("{}: {} is {}: finite numbers are needed", path, what, fmt::join(numbers, " ")));
}

void require_spacing(const std::string& path, std::span<const double> numbers) {
  require_finite(path, "the spacing", numbers);
  if (std::find(numbers.begin(), numbers.end(), 0.0) != numbers.end())
    throw InvalidInput(
        fmt::format("{}: the spacing is {}: numbers other than 0 are needed", path, fmt::join(numbers, " ")));
}

}  // namespace isolux::detail
