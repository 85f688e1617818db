#pragma once

#include <isolux/render/render.h>

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "bake_options.h"
#include "cap_options.h"
#include "isovalue_option.h"
#include "light_options.h"
#include "volume_options.h"

namespace isolux {

/// Pixels between the two pictures of --mode both.
inline constexpr int kGap = 4;

/// The command line of `isolux render`.
struct RenderOptions {
  VolumeOptions volume;
  LightOptions light;
  SideOption side;
  IsovalueOption iso;
  std::string output;
  std::string size = "800x600";
  std::string view = "30,20";
  std::string eye;
  std::string up = "0,0,1";
  std::string projection = "perspective";
  std::string frame = "box";
  double zoom = 1.0;
  std::string background;
  std::string mode;
  int samples = 3;
  std::optional<double> exposure;
  OuterOption outer;
  CapOptions parts;
  TraceOptions trace;  ///< --scene alone

  void add_to(CLI::App& command, Session& session);

  /// \throw UsageError
  [[nodiscard]] View looking() const;
  /// As linear radiance; nothing for a transparent one. \throw UsageError
  [[nodiscard]] std::optional<Vec3f> background_colour() const;
  /// `mode`, or what it is when it is not given. \throw UsageError if there is no light to show
  [[nodiscard]] std::string shown_mode() const;
  /// Whether every picture can be written. \throw UsageError
  void require_pictures() const;
  /// Whether surfaces are extracted, too.
  [[nodiscard]] bool needs_meshes() const { return parts.min_component > 0 || (frame == "surface" && eye.empty()); }
  /// Words that change nothing.
  void warn_of_no_effect(const std::optional<LightFile>& baked, const Session& session) const;
  /// What the report says of a picture.
  [[nodiscard]] nlohmann::json settings(float isovalue, OuterSide outside) const;
};

}  // namespace isolux
