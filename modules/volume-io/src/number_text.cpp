#include "number_text.h"

#include "scalars.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <charconv>

namespace isolux::detail {
namespace {
constexpr std::size_t kLongestNumber = 400;
}  // namespace

NumberText::NumberText(const std::string& path, std::uint64_t offset, std::string_view separators)
    : path_(path), file_(path, std::ios::binary), separators_(separators) {
  file_.seekg(std::streamoff(offset));
}

const std::string& NumberText::next() {
  word_.clear();
  for (int c = file_.get(); c != std::ifstream::traits_type::eof(); c = file_.get()) {
    const bool between = separators_.find(char(c)) != std::string_view::npos;
    if (between && !word_.empty()) break;
    if (!between) word_ += char(c);
    if (word_.size() > kLongestNumber) throw IoError(fmt::format("{}: the data hold no numbers as text", path_));
  }
  ++words_;
  return word_;
}

double NumberText::number(bool doubles) const {
  double value = 0.0;
  const auto [end, error] = std::from_chars(word_.data(), word_.data() + word_.size(), value);
  if (error == std::errc::invalid_argument || end != word_.data() + word_.size())
    throw IoError(
        fmt::format("{}: '{}', value {} of the data, is not a number", path_, word_.substr(0, 40), words_ - 1));
  if (error != std::errc() || (!doubles && !fits_float(value)))
    throw IoError(fmt::format("{}: '{}', value {} of the data, is beyond what {} holds", path_, word_.substr(0, 40),
                              words_ - 1, doubles ? "double" : "float32"));
  return value;
}

}  // namespace isolux::detail
