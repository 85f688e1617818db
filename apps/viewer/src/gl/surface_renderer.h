#pragma once

#include <isolux/core/surface_colour.h>
#include <isolux/mc_extract/indexed_mesh.h>
#include <isolux/render/camera.h>

#include <memory>
#include <optional>
#include <span>

#include "gl/light_textures.h"
#include "gl/objects.h"
#include "model/viewed_volume.h"
#include "ui/panes.h"

namespace isolux::viewer {

enum class SurfaceStyle { kShaded, kTriangles };

/// One view of the surface.
struct SurfaceView {
  Camera camera;
  Lighting lighting = Lighting::kLocal;
  SurfaceStyle style = SurfaceStyle::kShaded;
  SurfaceColour colour;
  float exposure = 1.0f;  ///< factor before the sRGB curve
  double aspect = 1.0;    ///< width over height of OpenGL's viewport
};

/// Draws an isosurface of a volume, lit locally or by its 3D textures, as 8-bit sRGB codes. Each kind of light has a
/// shader of its own.
class SurfaceRenderer {
 public:
  /// Needs a current OpenGL 3.3 core context, as all that follows. \throw GlError
  explicit SurfaceRenderer(std::shared_ptr<const ViewedVolume> volume);

  /// The level set of `isovalue`. \throw GlError if OpenGL has no memory for it
  void set_surface(const IndexedMesh& mesh, float isovalue);
  /// Light of the outer side, and of the inner one, which is seen on back faces; null: none of its own. What was there
  /// stays if anything is thrown. \throw GlError, InvalidInput as LightTextures
  void set_light(const IlluminationGrid& light, const IlluminationGrid* inner = nullptr);
  /// Of the light set last; zeros without any.
  [[nodiscard]] LightMemory light_memory() const { return light_ ? light_->textures.memory() : LightMemory{}; }
  /// e at the vertices of the surface, until another surface or light is set. \pre as many as vertices
  /// \throw GlError if OpenGL has no memory for it
  void set_exact_light(std::span<const Vec3f> radiance);

  /// Into the current framebuffer and viewport, with depth test. Global lighting without any light draws local.
  void draw(const SurfaceView& view);

 private:
  /// What of a light is computed at the vertices of one surface: near field and the normal's part.
  struct LightAtVertices {
    explicit LightAtVertices(const LightShader& kind);

    ShaderProgram program;
    Buffer values{GL_ARRAY_BUFFER};
    bool known = false;  ///< for the surface shown
  };

  /// Textures and the shader for their kind of light.
  struct Light {
    enum class Side { kOuter, kInner };
    Light(const Volume& volume, const IlluminationGrid& light, Side side);

    LightTextures textures;
    ShaderProgram program;
    std::optional<LightAtVertices> at_vertices;
  };

  /// Puts the program into use with what vertices need.
  void use(const ShaderProgram& program) const;
  /// The same with what drawing needs.
  void use(const ShaderProgram& program, const SurfaceView& view) const;
  /// Once for all frames: pixels would fetch the volume ten times each. Needs a framebuffer, though it draws nothing.
  void compute_at_vertices(Light& light) const;
  void read_from(Light& light, const SurfaceView& view);
  /// e or what is added to it at the vertices: what the vertex shader hands on.
  void hand_on(const Buffer& values) const;

  std::shared_ptr<const ViewedVolume> volume_;
  Vec3f centre_;
  double radius_ = 0.0;
  double unit_ = 1.0;  ///< world units that shaders count as one
  ShaderProgram local_;
  ShaderProgram exact_light_;
  ShaderProgram lines_;
  VertexArray vertex_array_;
  Buffer positions_{GL_ARRAY_BUFFER};
  Buffer normals_{GL_ARRAY_BUFFER};
  Buffer exact_{GL_ARRAY_BUFFER};
  Buffer indices_{GL_ELEMENT_ARRAY_BUFFER};
  GLsizei vertex_count_ = 0;
  GLsizei index_count_ = 0;
  float isovalue_ = 0.0f;
  bool has_exact_ = false;
  std::unique_ptr<Light> light_;
  std::unique_ptr<Light> inner_light_;
};

}  // namespace isolux::viewer
