#pragma once

#include <isolux/volume_io/light_file.h>

#include <CLI/App.hpp>
#include <optional>
#include <span>
#include <string>

#include "session.h"

namespace isolux {

/// --light LIGHT.nrrd and --force.
class LightOptions {
 public:
  void add_to(CLI::App& command, Session& session);
  [[nodiscard]] bool given() const { return !path_.empty(); }
  [[nodiscard]] const std::string& path() const { return path_; }
  /// --force without --light
  void warn_of_no_effect(const Session& session) const;
  /// Reads the light and refuses that of another volume unless --force. \throw IoError, InvalidInput
  [[nodiscard]] LightFile read(const Volume& volume, Session& session) const;
  /// The light of one side of what was read. \throw InvalidInput if it does not have it
  [[nodiscard]] const IlluminationGrid& of_side(const LightFile& light, LevelSetSide side) const {
    return light_of_side(light, side, path_);
  }

 private:
  std::string path_;
  bool force_ = false;
};

/// Where a light is of a range of isovalues, what lies outside is read from what lies next to it. `what` that means.
void warn_outside_light(const LightFile& light, std::span<const float> isovalues, const Session& session,
                        const std::string& what = "what is shown is not its light");

/// --side outer|inner.
class SideOption {
 public:
  void add_to(CLI::App& command, const std::string& help);
  [[nodiscard]] std::optional<LevelSetSide> given() const;
  /// "outer" or "inner"
  [[nodiscard]] std::string name() const { return or_outer() == LevelSetSide::kInner ? "inner" : "outer"; }
  [[nodiscard]] LevelSetSide or_outer() const { return given().value_or(LevelSetSide::kOuter); }

 private:
  std::string name_;
};

/// "lower" or "higher"
[[nodiscard]] std::string name_of(OuterSide outer);

/// --outer lower|higher.
class OuterOption {
 public:
  void add_to(CLI::App& command, const std::string& help);
  [[nodiscard]] OuterSide or_else(OuterSide by_default) const;

 private:
  std::string name_;
};

}  // namespace isolux
