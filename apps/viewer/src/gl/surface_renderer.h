#pragma once

#include <isolux/mc_extract/indexed_mesh.h>
#include <isolux/render/camera.h>

#include <memory>
#include <optional>
#include <span>

#include "gl/light_textures.h"
#include "gl/objects.h"
#include "ui/panes.h"

namespace isolux::viewer {

enum class SurfaceStyle { kShaded, kTriangles };

/// One view of the surface.
struct SurfaceView {
  Camera camera;
  Lighting lighting = Lighting::kLocal;
  SurfaceStyle style = SurfaceStyle::kShaded;
  Vec3f albedo{0.8f};
  float exposure = 1.0f;  ///< factor before the sRGB curve
  double aspect = 1.0;    ///< width over height of OpenGL's viewport
};

/// Draws an isosurface of a volume, lit locally or by its 3D textures, as 8-bit sRGB codes.
class SurfaceRenderer {
 public:
  /// Needs a current OpenGL 3.3 core context, as all that follows. \throw GlError
  explicit SurfaceRenderer(std::shared_ptr<const Volume> volume);

  /// The level set of `isovalue`. \throw GlError if OpenGL has no memory for it
  void set_surface(const IndexedMesh& mesh, float isovalue);
  /// \throw GlError, InvalidInput as LightTextures
  void set_light(const IlluminationGrid& light);
  /// Light of the inner side, seen on back faces, until another light is set. \pre set_light() \throw as set_light()
  void set_inner_light(const IlluminationGrid& light);
  /// e at the vertices of the surface, until another surface or light is set. \pre as many as vertices
  /// \throw GlError if OpenGL has no memory for it
  void set_exact_light(std::span<const Vec3f> radiance);

  /// Into the current framebuffer and viewport, with depth test. Global lighting without any light draws local.
  void draw(const SurfaceView& view) const;

 private:
  void draw_faces(bool global) const;

  std::shared_ptr<const Volume> volume_;
  Vec3f centre_;
  double radius_ = 0.0;
  ShaderProgram program_;
  VertexArray vertex_array_;
  Buffer positions_{GL_ARRAY_BUFFER};
  Buffer normals_{GL_ARRAY_BUFFER};
  Buffer exact_{GL_ARRAY_BUFFER};
  Buffer indices_{GL_ELEMENT_ARRAY_BUFFER};
  GLsizei index_count_ = 0;
  float isovalue_ = 0.0f;
  bool has_exact_ = false;
  std::optional<LightTextures> light_;
  std::optional<LightTextures> inner_light_;
};

}  // namespace isolux::viewer
