#pragma once

#include <isolux/bake/bake.h>
#include <isolux/raytrace_flat/scene.h>

#include <optional>

#include "ui/panes.h"

namespace isolux::viewer {

/// What the window starts with.
struct ViewerSettings {
  std::optional<double> isovalue;
  std::optional<Layout> layout;    ///< default: global where there is a light
  std::optional<OuterSide> outer;  ///< default: what the light says, else the scene
  double azimuth_deg = 30.0;
  double elevation_deg = 20.0;
  double exposure_stops = 0.0;
  bool help = false;
  bool exact_light = false;  ///< key x, from the start
  BackendChoice extractor;
  std::optional<Scene> scene;     ///< of drafts, and of exact light where there is no other; default: Scene{}
  double message_seconds = 10.0;  ///< that a message stays
  Run run;
};

}  // namespace isolux::viewer
