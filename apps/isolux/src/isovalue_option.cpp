#include "isovalue_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <variant>

#include "parse.h"
#include "session.h"
#include "usage.h"
#include "value_moments.h"

namespace isolux {
namespace {

constexpr std::string_view kSigma = "sigma";
constexpr std::uint64_t kMostIsovalues = 100000;

/// As it was told.
struct ToldIsovalue {
  double number = 0.0;
  bool in_sigmas = false;
};

/// \throw UsageError
ToldIsovalue told_isovalue(const std::string& text) {
  const bool in_sigmas = text.ends_with(kSigma);
  const std::string number = in_sigmas ? text.substr(0, text.size() - kSigma.size()) : text;
  if (!finite_number()(number).empty())
    throw UsageError(fmt::format("'{}': allowed is a number from -3.4e38 to 3.4e38, also with sigma behind it", text));
  return {.number = parse_numbers("--iso", number, 1)[0], .in_sigmas = in_sigmas};
}

float isovalue_of(const ToldIsovalue& told, const ValueMoments& moments) {
  return float(told.in_sigmas ? moments.mean + told.number * moments.standard_deviation : told.number);
}

/// "FIRST:LAST:COUNT". \throw UsageError
std::vector<ToldIsovalue> isovalue_steps(const std::string& text) {
  const auto parts = split(text, ':');
  if (parts.size() != 3) throw UsageError(fmt::format("'{}': allowed is FIRST:LAST:COUNT", text));
  const ToldIsovalue first = told_isovalue(parts[0]);
  const ToldIsovalue last = told_isovalue(parts[1]);
  if (first.in_sigmas != last.in_sigmas)
    throw UsageError(fmt::format("'{}': allowed is sigma behind both FIRST and LAST, or behind neither", text));
  std::string count = parts[2];
  if (!whole_number(1, kMostIsovalues)(count).empty())
    throw UsageError(fmt::format("'{}': allowed as COUNT is a whole number from 1 to {}", text, kMostIsovalues));
  std::vector<ToldIsovalue> steps(std::stoul(count), first);
  for (std::size_t i = 1; i < steps.size(); ++i)
    steps[i].number = std::lerp(first.number, last.number, double(i) / double(steps.size() - 1));
  return steps;
}

/// \throw UsageError
std::vector<ToldIsovalue> told_isovalues(const std::string& text) {
  std::vector<ToldIsovalue> all;
  for (const std::string& part : split(text, ',')) {
    const bool is_range = part.find(':') != std::string::npos;
    const auto some = is_range ? isovalue_steps(part) : std::vector<ToldIsovalue>{told_isovalue(part)};
    all.insert(all.end(), some.begin(), some.end());
    if (all.size() > kMostIsovalues)
      throw UsageError(fmt::format("'{}': allowed are {} isovalues at most", text, kMostIsovalues));
  }
  return all;
}

/// What `read` finds wrong with a text.
TextCheck check_by(const auto& read) {
  return [read](const std::string& text) {
    try {
      static_cast<void>(read(text));
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
}

}  // namespace

void IsovalueOption::add_to(CLI::App& command) {
  command
      .add_option("--iso", text_,
                  "isovalue, or as many standard deviations above the mean of the volume's values, such as 2.5sigma; "
                  "several as A,B,C or FIRST:LAST:COUNT")
      ->required()
      ->type_name("H|Nsigma")
      ->check(check_by(told_isovalues));
}

void IsovalueOption::add_one_to(CLI::App& command, const std::string& help) {
  command.add_option("--iso", text_, help)->type_name("H|Nsigma")->check(check_by(told_isovalue));
}

bool IsovalueOption::is_list() const { return text_.find_first_of(",:") != std::string::npos; }

std::vector<std::string> IsovalueOption::texts() const {
  std::vector<std::string> texts;
  for (const ToldIsovalue& told : told_isovalues(text_))
    texts.push_back(fmt::format("{}{}", float(told.number), told.in_sigmas ? kSigma : ""));
  return texts;
}

std::vector<float> IsovalueOption::in(const VolumeView& volume) const {
  const auto all = told_isovalues(text_);
  ValueMoments moments;
  if (std::any_of(all.begin(), all.end(), [](const ToldIsovalue& told) { return told.in_sigmas; }))
    moments = std::visit([](const auto& values) { return value_moments(values); }, volume.voxels());
  std::vector<float> isovalues;
  for (const ToldIsovalue& told : all) {
    isovalues.push_back(isovalue_of(told, moments));
    if (!std::isfinite(isovalues.back()))
      throw UsageError(
          fmt::format("--iso = '{}': of a mean of {:g} and a standard deviation of {:g} floats do not hold it", text_,
                      moments.mean, moments.standard_deviation));
  }
  return isovalues;
}

bool is_in_sigmas(const std::string& range) { return range.find(kSigma) != std::string::npos; }

ValueRange isovalue_range(const std::string& range, const std::optional<ValueMoments>& moments) {
  const auto refuse = [&](const std::string& why) {
    return UsageError(fmt::format("--iso-range = '{}': {}", range, why));
  };
  const auto parts = split(range, ':');
  std::vector<ToldIsovalue> ends;
  try {
    for (const std::string& part : parts) ends.push_back(told_isovalue(part));
  } catch (const UsageError& error) {
    throw refuse(fmt::format("allowed is LO:HI; {}", error.what()));
  }
  if (ends.size() != 2) throw refuse("allowed is LO:HI");
  const ValueMoments& values = moments.value_or(ValueMoments{.standard_deviation = 1.0});
  const ValueRange told{isovalue_of(ends[0], values), isovalue_of(ends[1], values)};
  if (!std::isfinite(told.low) || !std::isfinite(told.high))
    throw refuse("allowed are numbers that a 4-byte float holds");
  // Without a volume nobody knows which of a number and of standard deviations is more.
  if (told.low > told.high && (moments || ends[0].in_sigmas == ends[1].in_sigmas))
    throw refuse(fmt::format("LO is above HI{}",
                             is_in_sigmas(range) && moments ? fmt::format(" ({} and {})", told.low, told.high) : ""));
  return {std::min(told.low, told.high), std::max(told.low, told.high)};
}

std::string isovalues_lie(std::span<const float> isovalues) {
  if (isovalues.size() == 1) return fmt::format("isovalue {} lies", isovalues.front());
  const auto [least, most] = std::minmax_element(isovalues.begin(), isovalues.end());
  return fmt::format("{} isovalues, {} to {}, lie", isovalues.size(), *least, *most);
}

}  // namespace isolux
