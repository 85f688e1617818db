#pragma once

#include <isolux/core/volume.h>

#include <CLI/App.hpp>
#include <string>

namespace isolux {

/// --iso H, or Nsigma: N standard deviations above the mean of the volume's values, as maps of cryo-electron microscopy
/// are contoured.
class IsovalueOption {
 public:
  void add_to(CLI::App& command);
  /// The isovalue in this volume. Cost: of sigmas two passes. \throw UsageError if floats do not hold it
  [[nodiscard]] float in(const VolumeView& volume) const;

 private:
  std::string text_;
};

}  // namespace isolux
