#pragma once

#include <isolux/core/field.h>
#include <isolux/core/run.h>
#include <isolux/core/surface_colour.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/level_set_intersector.h>
#include <isolux/render/camera.h>
#include <isolux/render/image.h>

#include <functional>
#include <optional>

namespace isolux {

/// What a pixel sees of the surface.
struct SurfacePoint {
  Vec3 index{0.0};  ///< index space
  Vec3 world{0.0};
  Vec3 normal{0.0};       ///< world, unit, towards the outer side; (0,0,0) where there is none
  Vec3 towards_eye{0.0};  ///< world, unit
  bool outside = true;    ///< the camera sees the outer side
  /// Of a cap, the face of the volume's box that it is on: 2 axis, + 1 where the index is highest. `normal` is that
  /// face's.
  std::optional<int> cap{};
};

/// Radiance that a surface point sends to the camera.
using Shader = std::function<Vec3f(const SurfacePoint&)>;

struct RenderSettings {
  int width = 800;
  int height = 600;
  int supersampling = 3;  ///< squared: stratified rays a pixel
  float isovalue = 0.0f;
  OuterSide outer = OuterSide::kLower;
  GradientKind gradient = GradientKind::kCentralDifferences;
  std::optional<Vec3f> background{Vec3f(0.2f)};  ///< linear radiance; nothing: transparent (Image::coverage)
  std::optional<LevelSetSide> only{};            ///< shown alone; the camera looks through the other side
  /// Whether the surface is closed where it meets the box, as CapKind::kBox closes meshes: by the inner side's part of
  /// the box's faces; by the outer side's where the inner side alone is shown.
  bool cap = false;
  /// Whether a place (index space) of the surface or its cap is left out: the camera looks through it. Called from many
  /// threads. Nothing: all is shown.
  std::function<bool(const Vec3& index)> left_out{};
};

/// Draws level sets of one volume. What it needs to know of the volume beforehand it finds out once, in a pass that
/// costs a picture's tenth or so. Immutable, callable from many threads; the volume must outlive it.
class Renderer {
 public:
  /// \pre require_usable(volume)
  explicit Renderer(const Volume& volume) : field_(volume), intersector_(volume) {}
  explicit Renderer(Volume&& volume) = delete;

  /// Casts rays at the level set {f = isovalue} of the trilinear field itself, not at a mesh of it. The same bits for
  /// any number of threads. \throw InvalidInput for an empty picture; Cancelled
  [[nodiscard]] Image draw(const Camera& camera, const RenderSettings& settings, const Shader& shader,
                           const Run& run) const;

 private:
  TrilinearField field_;
  LevelSetIntersector intersector_;
};

/// A Renderer's only picture. \pre, \throw as there
[[nodiscard]] Image render(const Volume& volume, const Camera& camera, const RenderSettings& settings,
                           const Shader& shader, const Run& run);

/// e at a surface point.
using LightAt = std::function<Vec3f(const SurfacePoint&)>;

/// The baked light on a diffuse surface: albedo times e and what it emits. The inner side, which has no light of its
/// own, is drawn in a dim local shade.
[[nodiscard]] Shader global_shader(LightAt light, const SurfaceColour& colour);
/// The same with light of both sides, each where the camera sees it; a cap has no light on its inner side.
[[nodiscard]] Shader global_shader(LightAt outer, LightAt inner, const SurfaceColour& colour);

/// What graphics hardware shows without global light: a headlight and a hemisphere of sky, no shadows.
[[nodiscard]] Shader local_shader(const Vec3f& albedo);

/// The normal as a colour, (n + 1)/2: to look for faults.
[[nodiscard]] Shader normal_shader();

}  // namespace isolux
