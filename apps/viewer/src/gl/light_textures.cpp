#include "gl/light_textures.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/gl_texture/brick_textures.h>
#include <isolux/gl_texture/texture_uploader.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>
#include <span>
#include <string>
#include <utility>

namespace isolux::viewer {
namespace {

/// Whether 16 bits hold every value exactly, as those of 8-bit volumes.
bool fits_float16(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) {
    int exponent = 0;
    const float mantissa = 2048.0f * std::frexp(v, &exponent);  // 11 significant bits
    return mantissa == std::floor(mantissa) && std::fabs(v) < 65504.0f && (v == 0.0f || exponent > -14);
  });
}

Texture3D upload_grid(const IlluminationGrid& grid, const Lattice& volume, const char* format) {
  return uploaders().create({}, {{"format", format}})->upload(grid, volume);
}

/// What a user can do about a volume that no texture holds, whose light needs it: do without.
std::string what_to_bake(const LightShader& kind) {
  if (!kind.normals) return "bake with --set resampler.near_field=false";
  if (kind.near_field_terms == 0) return "bake with --set resampler.normals=false";
  return "bake with --set resampler.near_field=false --set resampler.normals=false";
}

Texture3D upload_values(const Volume& volume, const LightShader& kind) {
  const Index3 n = volume.lattice().size;
  const int most = largest_texture();
  if (std::max({n.x, n.y, n.z}) > most) {
    throw InvalidInput(fmt::format(
        "this light is shown with the volume's {}x{}x{} values in a 3D texture, and this OpenGL driver allows at most "
        "{} on an axis; {}",
        n.x, n.y, n.z, most, what_to_bake(kind)));
  }
  IlluminationGrid values(volume.lattice(), 1);
  values.values.assign(volume.values.values().begin(), volume.values.values().end());
  try {
    return upload_grid(values, volume.lattice(), fits_float16(values.values) ? "float16" : "float32");
  } catch (const GlError&) {
    throw GlError(
        fmt::format("this light is shown with the volume's {}x{}x{} values in a 3D texture, which OpenGL refuses; {}",
                    n.x, n.y, n.z, what_to_bake(kind)));
  }
}

void bind_texture(const ShaderProgram& program, GLint unit, const char* uniform, const Texture3D& texture) {
  glUniform1i(program.uniform(uniform), unit);
  glActiveTexture(GLenum(GL_TEXTURE0 + unit));
  glBindTexture(GL_TEXTURE_3D, texture.name());
}

}  // namespace

int largest_texture() {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &limit);
  return limit;
}

LightTextures::LightTextures(const Volume& volume, const IlluminationGrid& light)
    : volume_(volume.lattice()),
      mapping_(texture_mapping(light.lattice, volume_)),
      texels_(light.lattice.size),
      terms_(light.detail.near_field),
      ceiling_(light.detail.ceiling) {
  upload(LightReader(volume, light, TexelStorage::kBricks), light);
  if (!kind().at_vertices()) return;
  values_ = upload_values(volume, kind());
  memory_.volume = values_->bytes();
}

void LightTextures::upload(const LightReader& reader, const IlluminationGrid& light) {
  reference_isovalue_ = reader.reference_isovalue();
  memory_.dense = light.values.size() * std::size_t(light.detail.numbers()) * sizeof(std::uint16_t);
  if (reader.bricks() != nullptr) {
    BrickTextures textures = upload_bricks(*reader.bricks(), TexelFormat::kFloat16);
    memory_.light = textures.bytes();
    offsets_ = std::move(textures.values);
    slopes_ = std::move(textures.slopes);
    normals_ = std::move(textures.normal_slopes);
    pages_ = std::move(textures.pages);
    return;
  }
  memory_.light = memory_.dense;
  offsets_ = upload_grid(reader.offsets(), volume_, "float16");
  const auto upload_slopes = [&](const std::vector<float>& slopes, std::optional<Texture3D>& texture) {
    if (slopes.empty()) return;
    IlluminationGrid grid(light.lattice, light.channels);
    grid.values = slopes;
    texture = upload_grid(grid, volume_, "float16");
  };
  upload_slopes(light.detail.slopes, slopes_);
  for (unsigned a = 0; a < 3; ++a) upload_slopes(light.detail.normal_slopes[a], normals_[a]);
}

LightShader LightTextures::kind() const {
  return {.slopes = slopes_.has_value(),
          .normals = normals_[0].has_value(),
          .bricks = pages_.has_value(),
          .near_field_terms = int(terms_.size())};
}

void LightTextures::bind_at_vertices(const ShaderProgram& program) const {
  bind_texture(program, 2, "volume_values", *values_);
  glUniform3fv(program.uniform("grid_points"), 1, glm::value_ptr(Vec3f(volume_.size)));
  glUniform1f(program.uniform("volume_gain"), float(values_->gain()));
  const Vec3 spacing = volume_.frame.spacing();
  const double mean_spacing = std::cbrt(spacing.x * spacing.y * spacing.z);
  const glm::mat3 index_from_spacings(mean_spacing * glm::inverse(volume_.frame.axes));
  glUniformMatrix3fv(program.uniform("index_from_spacings"), 1, GL_FALSE, glm::value_ptr(index_from_spacings));
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    const auto element = [&](const char* name) { return program.uniform(fmt::format("{}[{}]", name, t).c_str()); };
    glUniform1f(element("near_field_step"), terms_[t].step);
    glUniform1f(element("near_field_mean"), terms_[t].mean);
    glUniform3fv(element("near_field_weight"), 1, glm::value_ptr(terms_[t].weight));
  }
  if (!normals_[0]) return;
  bind_places(program);
  bind_texture(program, 4, "light_normals_x", *normals_[0]);
  bind_texture(program, 5, "light_normals_y", *normals_[1]);
  bind_texture(program, 6, "light_normals_z", *normals_[2]);
  const Vec3f gains(normals_[0]->gain(), normals_[1]->gain(), normals_[2]->gain());
  glUniform3fv(program.uniform("light_normals_gain"), 1, glm::value_ptr(gains));
}

void LightTextures::bind_places(const ShaderProgram& program) const {
  glUniform3fv(program.uniform("light_scale"), 1, glm::value_ptr(Vec3f(mapping_.scale)));
  glUniform3fv(program.uniform("light_offset"), 1, glm::value_ptr(Vec3f(mapping_.offset)));
  if (!pages_) return;
  bind_texture(program, 3, "light_pages", *pages_);
  glUniform3fv(program.uniform("light_texels"), 1, glm::value_ptr(texels_));
  glUniform3fv(program.uniform("light_page_count"), 1, glm::value_ptr(Vec3f(pages_->size())));
  glUniform3fv(program.uniform("atlas_texels"), 1, glm::value_ptr(Vec3f(offsets_.size())));
}

void LightTextures::bind(const ShaderProgram& program) const {
  bind_places(program);
  if (slopes_) {
    bind_texture(program, 1, "light_slopes", *slopes_);
    glUniform1f(program.uniform("light_slope_gain"), float(slopes_->gain()));
  }
  bind_texture(program, 0, "light_offsets", offsets_);
  glUniform1f(program.uniform("light_gain"), float(offsets_.gain()));
  glUniform1f(program.uniform("reference_isovalue"), reference_isovalue_);
  glUniform1f(program.uniform("light_ceiling"), ceiling_);
}

}  // namespace isolux::viewer
