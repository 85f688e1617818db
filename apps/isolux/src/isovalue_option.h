#pragma once

#include <isolux/core/volume.h>

#include <CLI/App.hpp>
#include <span>
#include <string>
#include <vector>

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

/// Of those that something is wrong with, at least one: "isovalue 5 lies", "3 isovalues, 5 to 7, lie".
[[nodiscard]] std::string isovalues_lie(std::span<const float> isovalues);

}  // namespace isolux
