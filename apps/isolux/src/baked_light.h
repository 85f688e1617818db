#pragma once

#include <isolux/bake/light_on_box.h>
#include <isolux/render/render.h>
#include <isolux/resample/light_reader.h>
#include <isolux/volume_io/light_file.h>

#include <memory>

#include "render_options.h"

namespace isolux {

/// Baked light for pictures of any isovalue, made ready to be read once. A light of both sides shows each where it is,
/// whatever --outer says. Volume and light must outlive it, not what it gives.
class BakedLight {
 public:
  /// \throw InvalidInput if the light does not have the side that is shown; as light_on_box() for --cap
  BakedLight(const Volume& volume, const LightFile& light, const RenderOptions& options, OuterSide outer,
             Session& session);

  /// The surface with the exposure that is asked, what is seen beside it as it is.
  [[nodiscard]] Shader shader(float isovalue) const;

 private:
  const LightFile& light_;
  float exposure_;
  bool one_side_;  ///< is shown
  std::shared_ptr<const LightReader> outer_;
  std::shared_ptr<const LightReader> inner_;  ///< none: it has no light of its own
  std::shared_ptr<const BoxLight> cap_;       ///< none without --cap
};

}  // namespace isolux
