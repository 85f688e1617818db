#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake_options.h"
#include "cap_options.h"
#include "isovalue_option.h"
#include "light_options.h"
#include "volume_options.h"

namespace isolux {

/// The command line of `isolux extract`.
struct ExtractOptions {
  VolumeOptions volume;
  LightOptions light;
  SideOption side;
  TraceOptions trace;
  IsovalueOption iso;
  std::string output;
  std::string backend;
  OuterOption outer;
  std::vector<std::string> set;
  bool exact_light = false;
  std::optional<double> exposure;
  bool light_values = false;
  CapOptions parts;
  std::string normals = "gradient";

  [[nodiscard]] bool is_lit() const { return light.given() || exact_light; }
};

}  // namespace isolux
