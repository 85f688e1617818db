#pragma once

#include <isolux/core/volume.h>

#include <CLI/App.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "value_moments.h"

namespace isolux {

/// --iso H, or Nsigma: N standard deviations above the mean of the volume's values, as maps of cryo-electron microscopy
/// are contoured; of commands that take several also lists A,B,C and steps FIRST:LAST:COUNT of these.
class IsovalueOption {
 public:
  /// One or several, required.
  void add_to(CLI::App& command);
  /// One, or none.
  void add_one_to(CLI::App& command, const std::string& help);
  [[nodiscard]] bool given() const { return !text_.empty(); }
  /// Whether it was told as a list or as steps, which may be of one.
  [[nodiscard]] bool is_list() const;
  /// Each as the command line tells it, in the fewest digits: "-0.3", "2.5sigma".
  [[nodiscard]] std::vector<std::string> texts() const;
  /// The isovalues in this volume. Cost: of sigmas two passes. \throw UsageError if floats do not hold one
  [[nodiscard]] std::vector<float> in(const VolumeView& volume) const;

 private:
  std::string text_;
};

/// Whether a LO:HI of --iso-range takes the volume's values to be understood.
[[nodiscard]] bool is_in_sigmas(const std::string& range);

/// LO:HI of --iso-range, each as --iso tells one, in a volume of these values; of no volume what is told in standard
/// deviations counts these from 0. \throw UsageError naming what is allowed, also if LO lies above HI
[[nodiscard]] ValueRange isovalue_range(const std::string& range, const std::optional<ValueMoments>& moments);

/// Of those that something is wrong with, at least one: "isovalue 5 lies", "3 isovalues, 5 to 7, lie".
[[nodiscard]] std::string isovalues_lie(std::span<const float> isovalues);

}  // namespace isolux
