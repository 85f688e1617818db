#include "text_values.h"

#include "plain_text.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <cmath>

namespace isolux::detail {
namespace {

bool is_number(ScalarType type, const std::string& word) {
  if (reads_as(type, word)) return true;
  const auto value = parse_real(word);
  return (type == ScalarType::kFloat32 || type == ScalarType::kFloat64) && value && !std::isfinite(*value);
}

}  // namespace

DecodedValues read_text_values(NumberText& text, ScalarType type, std::uint64_t count, const ReadOptions& options,
                               const std::string& path, const Run& run) {
  AsWanted as_wanted(options, type == ScalarType::kFloat32);
  std::vector<float> values;
  values.reserve(count);
  bool rounded = false;
  while (values.size() < count) {
    const std::string& word = text.next();
    if (word.empty())
      throw IoError(fmt::format("{}: {} numbers of data expected, {} found", path, count, values.size()));
    if (!is_number(type, word))
      throw InvalidInput(fmt::format("{}: '{}', value {} of the data, is no {}", path, excerpt(word), values.size(),
                                     scalar_type_name(type)));
    const double value = as_wanted(text.number());
    values.push_back(float(value));
    rounded |= double(values.back()) != value && !std::isnan(value);
    if (values.size() % 65536 == 0) throw_if_stopped(run);
  }
  return {std::move(values), rounded, as_wanted.found_nodata()};
}

}  // namespace isolux::detail
