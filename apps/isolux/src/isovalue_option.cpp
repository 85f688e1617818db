#include "isovalue_option.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <variant>

#include "parse.h"
#include "session.h"
#include "usage.h"
#include "value_moments.h"

namespace isolux {
namespace {

constexpr std::string_view kSigma = "sigma";

/// The number before "sigma", or all of the text.
std::string number_in(const std::string& text) {
  return text.ends_with(kSigma) ? text.substr(0, text.size() - kSigma.size()) : text;
}

}  // namespace

void IsovalueOption::add_to(CLI::App& command) {
  const auto is_isovalue = [](const std::string& text) {
    const std::string wrong = finite_number()(number_in(text));
    if (wrong.empty()) return wrong;
    return fmt::format("'{}': allowed is a number from -3.4e38 to 3.4e38, also with sigma behind it", text);
  };
  command
      .add_option("--iso", text_,
                  "isovalue, or as many standard deviations above the mean of the volume's values, such as 2.5sigma")
      ->required()
      ->type_name("H|Nsigma")
      ->check(is_isovalue);
}

float IsovalueOption::in(const VolumeView& volume) const {
  const double number = parse_numbers("--iso", number_in(text_), 1)[0];
  if (!text_.ends_with(kSigma)) return float(number);
  const ValueMoments moments = std::visit([](const auto& values) { return value_moments(values); }, volume.voxels());
  const auto isovalue = float(moments.mean + number * moments.standard_deviation);
  if (std::isfinite(isovalue)) return isovalue;
  throw UsageError(fmt::format("--iso = '{}': of a mean of {:g} and a standard deviation of {:g} floats do not hold it",
                               text_, moments.mean, moments.standard_deviation));
}

}  // namespace isolux
