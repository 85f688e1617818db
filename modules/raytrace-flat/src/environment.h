#pragma once

#include <isolux/raytrace_flat/scene.h>

#include <vector>

#include "directions.h"

namespace isolux {

/// Of a colour, by the weights of Rec. 709.
[[nodiscard]] double luminance(const Vec3f& colour);

/// \throw InvalidInput unless it has as many pixels as its size says, one at least
void require_pixels(const ImageEnvironment& image);

/// What an environment shines from where. Owns nothing of the scene, which must outlive it.
class EnvironmentView {
 public:
  explicit EnvironmentView(const Environment& environment);

  /// Radiance from world direction `towards` (unit).
  [[nodiscard]] Vec3 radiance(const Vec3& towards) const;
  /// False where all directions are black.
  [[nodiscard]] bool shines() const;

 protected:
  /// Place in an image: columns 0..1 from the left edge, rows 0..1 from the top.
  struct Place {
    double column;
    double row;
  };
  [[nodiscard]] Place place(const Vec3& towards) const;
  [[nodiscard]] Vec3 image_radiance(const Place& place) const;

  const Environment* environment_;
  Frame frame_{};  ///< z: up; x: what an image's middle column shows; y: a quarter turn to the left of it
};

/// An environment made ready for drawing directions from it. Cost: one pass over an image's pixels.
class PreparedEnvironment : public EnvironmentView {
 public:
  explicit PreparedEnvironment(const Environment& environment);

  /// A direction drawn for the light of an image, and its density per solid angle.
  struct Sample {
    Vec3 towards{0.0};
    double density = 0.0;
  };
  /// True for images: their light is worth looking for.
  [[nodiscard]] bool has_samples() const { return !row_sums_.empty(); }
  [[nodiscard]] Sample sample(double u, double v) const;
  /// The density with which sample() gives this direction.
  [[nodiscard]] double density(const Vec3& towards) const;

 private:
  void prepare_image();

  // Of patches between pixel centres, where the bilinear interpolant of an image is one piece: (height + 1) rows of
  // `width`, running sums of luminance times solid angle. Empty unless the environment is an image that shines.
  std::vector<double> patch_sums_;
  std::vector<double> row_sums_;
};

}  // namespace isolux
