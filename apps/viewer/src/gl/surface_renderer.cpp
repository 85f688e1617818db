#include "gl/surface_renderer.h"

#include <isolux/resample/light_reader.h>

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <iterator>
#include <utility>

#include "camera/framing.h"
#include "gl/shader_sources.h"

namespace isolux::viewer {
namespace {

constexpr GLuint kExactAttribute = 2;
constexpr Vec3f kLineColour(0.08f, 0.1f, 0.2f);

template <class Values>
std::size_t bytes(const Values& values) {
  return values.size() * sizeof(values[0]);
}

}  // namespace

SurfaceRenderer::SurfaceRenderer(std::shared_ptr<const Volume> volume)
    : volume_(std::move(volume)),
      centre_(box_middle(volume_->lattice())),
      radius_(box_radius(volume_->lattice())),
      program_(kSurfaceVertexShader, {kSurfaceFragmentShader, light_reader_glsl()}) {
  vertex_array_.bind();
  const Buffer* attributes[] = {&positions_, &normals_, &exact_};
  for (GLuint i = 0; i < std::size(attributes); ++i) {
    attributes[i]->bind();
    if (i != kExactAttribute) glEnableVertexAttribArray(i);
    glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  }
  indices_.bind();
}

void SurfaceRenderer::set_surface(const IndexedMesh& mesh, float isovalue) {
  index_count_ = 0;
  set_exact_light({});
  vertex_array_.bind();
  positions_.fill(mesh.positions.data(), bytes(mesh.positions));
  normals_.fill(mesh.normals.data(), bytes(mesh.normals));
  indices_.fill(mesh.triangles.data(), bytes(mesh.triangles));
  index_count_ = GLsizei(mesh.triangles.size() * 3);
  isovalue_ = isovalue;
}

void SurfaceRenderer::set_light(const IlluminationGrid& light) {
  light_.emplace(*volume_, light);
  inner_light_.reset();
  set_exact_light({});
}

void SurfaceRenderer::set_inner_light(const IlluminationGrid& light) { inner_light_.emplace(*volume_, light); }

void SurfaceRenderer::set_exact_light(std::span<const Vec3f> radiance) {
  has_exact_ = !radiance.empty();
  vertex_array_.bind();
  if (has_exact_) {
    exact_.fill(radiance.data(), radiance.size_bytes());
    glEnableVertexAttribArray(kExactAttribute);
  } else {
    glDisableVertexAttribArray(kExactAttribute);
  }
}

/// All triangles; where both sides have light, front faces and then back faces with theirs.
void SurfaceRenderer::draw_faces(bool global) const {
  const bool both = global && inner_light_;
  glUniform1i(program_.uniform("inner_light"), 0);
  if (both) {
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
  }
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
  if (!both) return;
  inner_light_->bind(program_);
  glUniform1i(program_.uniform("inner_light"), 1);
  glCullFace(GL_FRONT);
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
  glDisable(GL_CULL_FACE);
}

void SurfaceRenderer::draw(const SurfaceView& view) const {
  if (index_count_ == 0) return;
  const bool global = view.lighting == Lighting::kGlobal && (light_ || has_exact_);
  const Vec3 centre(centre_);
  const glm::mat4 clip(clip_from_centred(view.camera, centre, radius_, view.aspect));
  // Place in the box from a position relative to the box's middle, whose place is 1/2 on each axis.
  const Lattice& lattice = volume_->lattice();
  Mat3 axes = lattice.frame.axes;
  for (int a = 0; a < 3; ++a) axes[a] *= double(lattice.size[a] - 1);
  const glm::mat3 place(glm::inverse(axes));
  const Vec3f eye(view.camera.eye - centre);
  program_.use();
  glUniform3fv(program_.uniform("centre"), 1, glm::value_ptr(centre_));
  glUniformMatrix4fv(program_.uniform("clip_from_centred"), 1, GL_FALSE, glm::value_ptr(clip));
  glUniformMatrix3fv(program_.uniform("place_from_centred"), 1, GL_FALSE, glm::value_ptr(place));
  glUniform3fv(program_.uniform("eye"), 1, glm::value_ptr(eye));
  glUniform3fv(program_.uniform("albedo"), 1, glm::value_ptr(view.albedo));
  glUniform1f(program_.uniform("exposure"), view.exposure);
  glUniform1i(program_.uniform("global_light"), global ? 1 : 0);
  glUniform1i(program_.uniform("flat_colour"), 0);
  glUniform3fv(program_.uniform("line_colour"), 1, glm::value_ptr(kLineColour));
  glUniform1f(program_.uniform("isovalue"), isovalue_);
  glUniform1i(program_.uniform("exact_light"), has_exact_ ? 1 : 0);
  if (global && light_) light_->bind(program_);
  glEnable(GL_DEPTH_TEST);
  vertex_array_.bind();
  const bool triangles = view.style == SurfaceStyle::kTriangles;
  if (triangles) {
    // Pushed back so that the lines on the same triangles win the depth test.
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.0f, 1.0f);
  }
  draw_faces(global);
  if (!triangles) return;
  glDisable(GL_POLYGON_OFFSET_FILL);
  glUniform1i(program_.uniform("flat_colour"), 1);
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

}  // namespace isolux::viewer
