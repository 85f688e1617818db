#pragma once

#include <string>
#include <vector>

#include "figures.h"

namespace isolux::bench {

/// One law, tried on one backend: the worst figure found and what is allowed.
struct Verdict {
  std::string law;
  std::string backend;
  double cases = 0.0;
  std::string figure;
  double worst = 0.0;
  double allowed = 0.0;

  [[nodiscard]] bool passes() const { return worst <= allowed; }  ///< false for NaN
};

/// Collects verdicts.
class Judge {
 public:
  void add(Verdict verdict) { verdicts_.push_back(std::move(verdict)); }
  [[nodiscard]] const std::vector<Verdict>& verdicts() const { return verdicts_; }

  /// A row each.
  [[nodiscard]] Table table() const;
  /// A sentence for each verdict that does not pass.
  [[nodiscard]] std::vector<std::string> failures() const;

 private:
  std::vector<Verdict> verdicts_;
};

}  // namespace isolux::bench
