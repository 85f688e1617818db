#pragma once

#include <isolux/raytrace_flat/scene.h>

#include <optional>

namespace isolux {

/// A scene whose image, if it has one, is parted in two that add up to it: what hemisphere rays find often enough by
/// chance, and what is so much brighter that it is aimed at like a lamp. Cost: passes over the pixels.
class SceneParts {
 public:
  /// \pre the scene outlives this
  explicit SceneParts(const Scene& scene);

  [[nodiscard]] const Scene& whole() const { return whole_; }
  /// Under the part for rays by chance.
  [[nodiscard]] const Scene& soft() const { return soft_ ? *soft_ : whole_; }
  /// The part to aim at; null where there is none.
  [[nodiscard]] const Environment* bright() const { return bright_ ? &*bright_ : nullptr; }

 private:
  const Scene& whole_;
  std::optional<Scene> soft_;
  std::optional<Environment> bright_;
};

/// What the scene's light sources alone shine.
[[nodiscard]] Scene lamps_of(const Scene& scene);

}  // namespace isolux
