#include "gl/surface_renderer.h"

#include <fmt/format.h>
#include <isolux/resample/light_reader.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <iterator>
#include <string>
#include <utility>

#include "camera/framing.h"
#include "gl/shader_sources.h"

namespace isolux::viewer {
namespace {

constexpr GLuint kExtraAttribute = 2;
enum class Shading { kLocal, kExact, kRead, kReadInner, kLines };

std::string fragment_shader(Shading shading) {
  return fmt::format(
      "#version 330 core\n"
      "const bool flat_colour = {};\n"
      "const bool global_light = {};\n"
      "const bool exact_light = {};\n"
      "const bool inner_light = {};\n{}",
      shading == Shading::kLines, shading != Shading::kLocal && shading != Shading::kLines, shading == Shading::kExact,
      shading == Shading::kReadInner, kSurfaceFragmentShader);
}

constexpr Vec3f kLineColour(0.08f, 0.1f, 0.2f);

/// A power of two near the box's radius, as far as its inverse is a float too: squares of lengths in world units may be
/// beyond floats.
double unit_for(double radius) { return std::exp2(std::clamp(std::round(std::log2(radius)), -126.0, 126.0)); }

template <class Values>
std::size_t bytes(const Values& values) {
  return values.size() * sizeof(values[0]);
}

}  // namespace

SurfaceRenderer::SurfaceRenderer(std::shared_ptr<const ViewedVolume> volume)
    : volume_(std::move(volume)),
      centre_(box_middle(volume_->lattice())),
      radius_(box_radius(volume_->lattice())),
      unit_(unit_for(radius_)),
      local_({kSurfaceVertexShader}, {fragment_shader(Shading::kLocal), light_reader_glsl({})}),
      exact_light_({kSurfaceVertexShader}, {fragment_shader(Shading::kExact), light_reader_glsl({})}),
      lines_({kSurfaceVertexShader}, {fragment_shader(Shading::kLines), light_reader_glsl({})}) {
  vertex_array_.bind();
  const Buffer* attributes[] = {&positions_, &normals_};
  for (GLuint i = 0; i < std::size(attributes); ++i) {
    attributes[i]->bind();
    glEnableVertexAttribArray(i);
    glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  }
  indices_.bind();
}

void SurfaceRenderer::set_surface(const IndexedMesh& mesh, float isovalue) {
  index_count_ = 0;
  vertex_array_.bind();
  positions_.fill(mesh.positions.data(), bytes(mesh.positions));
  normals_.fill(mesh.normals.data(), bytes(mesh.normals));
  indices_.fill(mesh.triangles.data(), bytes(mesh.triangles));
  vertex_count_ = GLsizei(mesh.positions.size());
  index_count_ = GLsizei(mesh.triangles.size() * 3);
  isovalue_ = isovalue;
  for (Light* light : {light_.get(), inner_light_.get()})
    if (light != nullptr && light->at_vertices) light->at_vertices->known = false;
  set_exact_light({});
}

SurfaceRenderer::LightAtVertices::LightAtVertices(const LightShader& kind)
    : program({kLightVertexShader, light_at_vertices_glsl(kind)}, {}, "at_vertex") {}

SurfaceRenderer::Light::Light(const Volume& volume, const IlluminationGrid& light, Side side)
    : textures(volume, light),
      program({kSurfaceVertexShader}, {fragment_shader(side == Side::kOuter ? Shading::kRead : Shading::kReadInner),
                                       light_reader_glsl(textures.kind())}) {
  if (textures.kind().at_vertices()) at_vertices.emplace(textures.kind());
}

void SurfaceRenderer::set_light(const IlluminationGrid& light, const IlluminationGrid* inner) {
  auto outer_light = std::make_unique<Light>(volume_->floats(), light, Light::Side::kOuter);
  std::unique_ptr<Light> inner_light;
  if (inner != nullptr) inner_light = std::make_unique<Light>(volume_->floats(), *inner, Light::Side::kInner);
  light_ = std::move(outer_light);
  inner_light_ = std::move(inner_light);
  set_exact_light({});
}

void SurfaceRenderer::set_exact_light(std::span<const Vec3f> radiance) {
  has_exact_ = false;
  if (radiance.empty()) return;
  exact_.fill(radiance.data(), radiance.size_bytes());
  has_exact_ = true;
}

void SurfaceRenderer::compute_at_vertices(Light& light) const {
  LightAtVertices& added = *light.at_vertices;
  if (added.known) return;
  added.values.reserve(std::size_t(vertex_count_) * sizeof(Vec3f));
  use(added.program);
  light.textures.bind_at_vertices(added.program);
  vertex_array_.bind();
  glDisableVertexAttribArray(kExtraAttribute);
  glEnable(GL_RASTERIZER_DISCARD);
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, added.values.name());
  glBeginTransformFeedback(GL_POINTS);
  glDrawArrays(GL_POINTS, 0, vertex_count_);
  glEndTransformFeedback();
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
  glDisable(GL_RASTERIZER_DISCARD);
  added.known = true;
}

void SurfaceRenderer::hand_on(const Buffer& values) const {
  vertex_array_.bind();
  values.bind();
  glVertexAttribPointer(kExtraAttribute, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  glEnableVertexAttribArray(kExtraAttribute);
}

void SurfaceRenderer::read_from(Light& light, const SurfaceView& view) {
  vertex_array_.bind();
  glDisableVertexAttribArray(kExtraAttribute);
  if (light.at_vertices) {
    compute_at_vertices(light);
    hand_on(light.at_vertices->values);
  }
  use(light.program, view);
  light.textures.bind(light.program);
}

void SurfaceRenderer::use(const ShaderProgram& program) const {
  // Place in the box from a position relative to the box's middle, whose place is 1/2 on each axis.
  const Lattice& lattice = volume_->lattice();
  Mat3 axes = lattice.frame.axes;
  for (int a = 0; a < 3; ++a) axes[a] *= double(lattice.size[a] - 1);
  const glm::mat3 place(unit_ * glm::inverse(axes));
  program.use();
  glUniform3fv(program.uniform("centre"), 1, glm::value_ptr(centre_));
  glUniform1f(program.uniform("scale"), float(1.0 / unit_));
  glUniformMatrix3fv(program.uniform("place_from_centred"), 1, GL_FALSE, glm::value_ptr(place));
  glUniform1f(program.uniform("isovalue"), isovalue_);
}

void SurfaceRenderer::use(const ShaderProgram& program, const SurfaceView& view) const {
  const Vec3 centre(centre_);
  glm::dmat4 clip = clip_from_centred(view.camera, centre, radius_, view.aspect);
  clip[3] /= unit_;  // homogeneous: in place of all else times the unit
  const Vec3f eye((view.camera.eye - centre) / unit_);
  use(program);
  glUniformMatrix4fv(program.uniform("clip_from_centred"), 1, GL_FALSE, glm::value_ptr(glm::mat4(clip)));
  glUniform3fv(program.uniform("eye"), 1, glm::value_ptr(eye));
  glUniform3fv(program.uniform("albedo"), 1, glm::value_ptr(view.colour.albedo));
  glUniform3fv(program.uniform("emission"), 1, glm::value_ptr(view.colour.emission));
  glUniform1f(program.uniform("exposure"), view.exposure);
  glUniform3fv(program.uniform("line_colour"), 1, glm::value_ptr(kLineColour));
}

void SurfaceRenderer::draw(const SurfaceView& view) {
  if (index_count_ == 0) return;
  const bool global = view.lighting == Lighting::kGlobal;
  const bool both = global && inner_light_;
  vertex_array_.bind();
  glDisableVertexAttribArray(kExtraAttribute);
  if (global && has_exact_) {
    use(exact_light_, view);
    hand_on(exact_);
  } else if (global && light_) {
    read_from(*light_, view);
  } else {
    use(local_, view);
  }
  glEnable(GL_DEPTH_TEST);
  const bool triangles = view.style == SurfaceStyle::kTriangles;
  if (triangles) {
    // Pushed back so that the lines on the same triangles win the depth test.
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.0f, 1.0f);
  }
  if (both) {
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
  }
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
  if (both) {
    read_from(*inner_light_, view);
    glCullFace(GL_FRONT);
    glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
    glDisable(GL_CULL_FACE);
  }
  if (!triangles) return;
  glDisable(GL_POLYGON_OFFSET_FILL);
  use(lines_, view);
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

}  // namespace isolux::viewer
