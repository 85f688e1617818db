#include "gl/light_textures.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/gl_texture/texture_uploader.h>
#include <isolux/resample/light_reader.h>

#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

namespace isolux::viewer {
namespace {

constexpr std::size_t kMostTerms = 4;  // as light_reader_glsl() declares them

Texture3D upload(const IlluminationGrid& grid, const Lattice& volume, const char* format) {
  return uploaders().create({}, {{"format", format}})->upload(grid, volume);
}

Texture3D upload_values(const Volume& volume) {
  IlluminationGrid values(volume.lattice(), 1);
  values.values.assign(volume.values.values().begin(), volume.values.values().end());
  return upload(values, volume.lattice(), "float32");
}

}  // namespace

LightTextures::LightTextures(const Volume& volume, const IlluminationGrid& light)
    : volume_(volume.lattice()), terms_(light.detail.near_field), ceiling_(light.detail.ceiling) {
  if (light.detail.empty()) {
    offsets_ = upload(light, volume_, "float16");
    return;
  }
  if (terms_.size() > kMostTerms) {
    throw InvalidInput(
        fmt::format("a light with {} near-field terms: the window reads up to {}", terms_.size(), kMostTerms));
  }
  const LightReader reader(volume, light);
  reference_isovalue_ = reader.reference_isovalue();
  // Offsets and slopes cancel: far from the reference isovalue both are large.
  offsets_ = upload(reader.offsets(), volume_, "float32");
  if (!reader.slopes().empty()) {
    IlluminationGrid slopes(light.lattice, light.channels);
    slopes.values = reader.slopes();
    slopes_ = upload(slopes, volume_, "float32");
  }
  if (!terms_.empty()) values_ = upload_values(volume);
}

void LightTextures::bind(const ShaderProgram& program) const {
  const auto texture = [&](GLint unit, const char* uniform, const Texture3D* bound) {
    glUniform1i(program.uniform(uniform), unit);
    glActiveTexture(GLenum(GL_TEXTURE0 + unit));
    glBindTexture(GL_TEXTURE_3D, bound != nullptr ? bound->name() : 0);
  };
  texture(2, "volume_values", values_ ? &*values_ : nullptr);
  texture(1, "light_slopes", slopes_ ? &*slopes_ : nullptr);
  texture(0, "light_offsets", &offsets_);
  glUniform1f(program.uniform("light_gain"), float(offsets_.gain()));
  glUniform3fv(program.uniform("light_scale"), 1, glm::value_ptr(Vec3f(offsets_.scale())));
  glUniform3fv(program.uniform("light_offset"), 1, glm::value_ptr(Vec3f(offsets_.offset())));
  glUniform1i(program.uniform("light_has_slopes"), slopes_ ? 1 : 0);
  glUniform1f(program.uniform("reference_isovalue"), reference_isovalue_);
  glUniform1f(program.uniform("light_ceiling"), ceiling_);
  glUniform1i(program.uniform("near_field_terms"), GLint(terms_.size()));
  if (terms_.empty()) return;
  const Vec3 spacing = volume_.frame.spacing();
  glUniform3fv(program.uniform("grid_points"), 1, glm::value_ptr(Vec3f(volume_.size)));
  glUniformMatrix3fv(program.uniform("index_from_world"), 1, GL_FALSE,
                     glm::value_ptr(glm::mat3(glm::inverse(volume_.frame.axes))));
  glUniform1f(program.uniform("mean_spacing"), float(std::cbrt(spacing.x * spacing.y * spacing.z)));
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    const auto element = [&](const char* name) { return program.uniform(fmt::format("{}[{}]", name, t).c_str()); };
    glUniform1f(element("near_field_step"), terms_[t].step);
    glUniform1f(element("near_field_mean"), terms_[t].mean);
    glUniform3fv(element("near_field_weight"), 1, glm::value_ptr(terms_[t].weight));
  }
}

}  // namespace isolux::viewer
