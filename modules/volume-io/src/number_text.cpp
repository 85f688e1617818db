#include "number_text.h"

#include "scalars.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <charconv>

namespace isolux::detail {
namespace {
constexpr std::size_t kLongestNumber = 400;
}  // namespace

std::optional<double> parse_real(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || text.empty()) return std::nullopt;
  if (error == std::errc()) return value;
  const bool is_small = text.find("e-") != std::string_view::npos || text.find("E-") != std::string_view::npos;
  return error == std::errc::result_out_of_range && is_small ? std::optional(0.0) : std::nullopt;
}

NumberText::NumberText(const std::string& path, std::uint64_t offset, std::string_view separators,
                       std::optional<char> end)
    : path_(path), file_(path, std::ios::binary), separators_(separators), end_(end), offset_(offset) {
  file_.seekg(std::streamoff(offset));
}

const std::string& NumberText::next() {
  word_.clear();
  for (int c = file_.get(); c != std::ifstream::traits_type::eof(); c = file_.get()) {
    if (end_ && char(c) == *end_) {
      file_.unget();
      break;
    }
    ++offset_;
    const bool between = separators_.find(char(c)) != std::string_view::npos;
    if (between && !word_.empty()) break;
    if (!between) word_ += char(c);
    if (word_.size() > kLongestNumber) throw IoError(fmt::format("{}: the data hold no numbers as text", path_));
  }
  ++words_;
  return word_;
}

double NumberText::number() const {
  const auto value = parse_real(word_);
  if (!value || !fits_float(*value))
    throw InvalidInput(fmt::format("{}: '{}', value {} of the data, is {}", path_, word_.substr(0, 40), words_ - 1,
                                   value ? "beyond what float32 holds" : "not a number"));
  return *value;
}

}  // namespace isolux::detail
