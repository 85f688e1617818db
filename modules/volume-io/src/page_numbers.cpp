#include "format_checks.h"
#include "plain_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>

namespace isolux::detail {
namespace {

// The number in which a name differs from the next.
struct PageNumber {
  std::size_t at = 0;  ///< where it begins
  std::size_t digits = 0;
  std::uint64_t value = 0;
  std::uint64_t step = 0;  ///< to the next
};

std::size_t digits_at(const std::string& name, std::size_t at) {
  return std::size_t(std::find_if_not(name.begin() + std::ptrdiff_t(at), name.end(), is_digit) - name.begin()) - at;
}

std::optional<std::uint64_t> whole(const std::string& digits) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return error == std::errc() ? std::optional(value) : std::nullopt;
}

// Nothing for names that differ in more than one number.
std::optional<PageNumber> page_number(const std::string& name, const std::string& next) {
  PageNumber number;
  number.at = std::size_t(std::mismatch(name.begin(), name.end(), next.begin(), next.end()).first - name.begin());
  while (number.at > 0 && is_digit(name[number.at - 1])) --number.at;
  number.digits = digits_at(name, number.at);
  const std::size_t digits = digits_at(next, number.at);
  const auto value = whole(name.substr(number.at, number.digits));
  const auto behind = whole(next.substr(number.at, digits));
  if (!value || !behind || *behind <= *value) return std::nullopt;
  if (name.substr(number.at + number.digits) != next.substr(number.at + digits)) return std::nullopt;
  number.value = *value;
  number.step = *behind - *value;
  return number;
}

}  // namespace

std::string missing_page(const std::string& folder, const std::vector<std::string>& files) {
  std::vector<std::string> names;
  for (const auto& file : files) names.push_back(std::filesystem::path(file).filename().string());
  std::vector<PageNumber> numbers;
  for (std::size_t i = 1; i < names.size(); ++i) {
    const auto number = page_number(names[i - 1], names[i]);
    if (!number || (i > 1 && number->at != numbers.front().at)) return {};
    numbers.push_back(*number);
  }
  if (numbers.size() < 2) return {};
  const std::uint64_t usual = std::min_element(numbers.begin(), numbers.end(), [](const auto& a, const auto& b) {
                                return a.step < b.step;
                              })->step;
  const auto is_usual = [&](const PageNumber& number) { return number.step == usual; };
  // Times and the like leap anyhow; numbers of pages mostly by one step, and over pages that are not there by several.
  const auto count = std::size_t(std::count_if(numbers.begin(), numbers.end(), is_usual));
  if (count < 2 || 2 * count <= numbers.size()) return {};
  if (std::any_of(numbers.begin(), numbers.end(), [&](const auto& n) { return n.step % usual != 0; })) return {};
  const auto gap = std::find_if_not(numbers.begin(), numbers.end(), is_usual);
  if (gap == numbers.end()) return {};
  const auto before = std::size_t(gap - numbers.begin());
  return fmt::format(
      "{}: a page of the number {:0{}} is missing between {} and {}: the pages are taken as evenly spaced all the same",
      folder, gap->value + usual, gap->digits, names[before], names[before + 1]);
}

}  // namespace isolux::detail
