#pragma once

#include <CLI/App.hpp>
#include <CLI/Validators.hpp>
#include <cstdint>
#include <functional>
#include <string>

namespace isolux {

/// CLI11's words for what is wrong with a command line, with the nearest known option or command for one that is not
/// known.
[[nodiscard]] std::string explain(const CLI::ParseError& error, const CLI::App& app);

/// The first word that gives an option nothing, as in `--report=`: CLI11 would take the next word for the value. "" if
/// there is none.
[[nodiscard]] std::string word_without_value(int argc, char** argv);

/// Checks for CLI::Option::check; each gives what is wrong with the text, or "".
using TextCheck = std::function<std::string(const std::string&)>;

/// A number above 0.
[[nodiscard]] TextCheck above_zero();
/// A number from `low` to `high`.
[[nodiscard]] TextCheck number_within(double low, double high);
/// A number that a float can hold.
[[nodiscard]] TextCheck finite_number();
/// For CLI::Option::transform: a whole number in decimal digits. CLI11 takes 010 for eight and 0x10 for sixteen.
[[nodiscard]] CLI::Validator whole_number(std::uint64_t low, std::uint64_t high);
/// KEY=VALUE. What is not is perhaps the VOLUME, which CLI11 takes for one more setting.
[[nodiscard]] TextCheck key_and_value();
/// Not empty: "" is what a script's unset variable leaves.
[[nodiscard]] TextCheck something();

}  // namespace isolux
