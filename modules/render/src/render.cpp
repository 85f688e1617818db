#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/core/random.h>
#include <isolux/render/render.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

namespace isolux {
namespace {

/// One picture's constants, and the radiance of single rays.
class Raycaster {
 public:
  Raycaster(const TrilinearField& field, const LevelSetIntersector& intersector, const Camera& camera,
            const RenderSettings& settings, const Shader& shader)
      : camera_(camera),
        settings_(settings),
        shader_(shader),
        field_(field),
        intersector_(intersector),
        world_to_index_(glm::inverse(field.lattice().frame.axes)) {}

  void draw_pixel(int x, int y, std::uint64_t seed, Image& image) const {
    RandomStream random(seed, std::uint64_t(y) * std::uint64_t(settings_.width) + std::uint64_t(x));
    const int n = settings_.supersampling;
    Vec3f sum(0.0f);
    int seen = 0;
    for (int s = 0; s < n * n; ++s) {
      const int column = s % n;
      const int row = s / n;
      const double px = x + (column + random.uniform_double()) / n;
      const double py = y + (row + random.uniform_double()) / n;
      const auto surface = radiance((2.0 * px - settings_.width) / settings_.height, 1.0 - 2.0 * py / settings_.height);
      if (surface) ++seen;
      sum += surface ? *surface : settings_.background.value_or(Vec3f(0.0f));
    }
    const int counted = settings_.background ? n * n : seen;
    image.at(x, y) = sum / float(std::max(1, counted));
    if (!image.coverage.empty()) image.coverage[image.offset(x, y)] = float(seen) / float(n * n);
  }

 private:
  /// What the surface sends along the ray through a point of the picture; nothing where there is none.
  [[nodiscard]] std::optional<Vec3f> radiance(double x, double y) const {
    const Vec3 direction = camera_.direction(x, y);
    const Vec3 index_direction = world_to_index_ * direction;
    const Vec3 begin = field_.lattice().frame.index(camera_.origin(x, y));
    auto hit = intersector_.first_hit(begin, index_direction, settings_.isovalue);
    if (!hit) return std::nullopt;
    const LevelSetSide seen = side_seen(hit->position, index_direction);
    if (settings_.only && seen != *settings_.only) {
      // Beyond it the ray is on the other side of the level set and meets it from there next.
      const bool outer = *settings_.only == LevelSetSide::kOuter;
      hit = intersector_.next_hit(hit->position, index_direction, settings_.isovalue,
                                  outer ? settings_.outer : opposite(settings_.outer));
      if (!hit) return std::nullopt;
    }
    SurfacePoint point;
    point.index = hit->position;
    point.world = field_.lattice().frame.world(hit->position);
    point.normal = field_.normal(hit->position, settings_.outer, settings_.gradient);
    point.towards_eye = -direction;
    point.outside = settings_.only.value_or(seen) == LevelSetSide::kOuter;
    return shader_(point);
  }

  /// The cell's own gradient says which side is seen; the smoothed normal may disagree near silhouettes.
  [[nodiscard]] LevelSetSide side_seen(const Vec3& index, const Vec3& index_direction) const {
    const double rise = glm::dot(field_.cell_gradient(index), index_direction);
    const bool outside = settings_.outer == OuterSide::kLower ? rise >= 0.0 : rise <= 0.0;
    return outside ? LevelSetSide::kOuter : LevelSetSide::kInner;
  }

  const Camera& camera_;
  const RenderSettings& settings_;
  const Shader& shader_;
  const TrilinearField& field_;
  const LevelSetIntersector& intersector_;
  Mat3 world_to_index_;
};

/// A headlight over the viewer's shoulder and a sky of half its strength.
float local_light(const SurfacePoint& point) {
  const Vec3 n = point.outside ? point.normal : -point.normal;
  const Vec3 sky(0.0, 0.0, 1.0);
  const double head = std::max(0.0, glm::dot(n, point.towards_eye));
  return float(0.7 * head + 0.15 * (1.0 + glm::dot(n, sky)));
}

}  // namespace

Image Renderer::draw(const Camera& camera, const RenderSettings& settings, const Shader& shader, const Run& run) const {
  if (settings.width < 1 || settings.height < 1 || settings.supersampling < 1) {
    throw InvalidInput(fmt::format("a picture of {}x{} pixels with {}x{} rays each: all must be at least 1",
                                   settings.width, settings.height, settings.supersampling, settings.supersampling));
  }
  Image image(settings.width, settings.height);
  if (!settings.background) image.coverage.assign(image.pixels.size(), 0.0f);
  const Raycaster raycaster(field_, intersector_, camera, settings, shader);
  parallel_blocks(std::size_t(settings.height), 4, run, "render", [&](const Block& rows) {
    for (auto y = int(rows.begin); y < int(rows.end); ++y) {
      for (int x = 0; x < settings.width; ++x) raycaster.draw_pixel(x, y, run.seed, image);
    }
  });
  return image;
}

Image render(const Volume& volume, const Camera& camera, const RenderSettings& settings, const Shader& shader,
             const Run& run) {
  return Renderer(volume).draw(camera, settings, shader, run);
}

Shader global_shader(LightAt light, const SurfaceColour& colour) {
  return [light = std::move(light), colour](const SurfacePoint& point) {
    return point.outside ? colour.shown(light(point)) : colour.albedo * (0.1f * local_light(point));
  };
}

Shader global_shader(LightAt outer, LightAt inner, const SurfaceColour& colour) {
  return [outer = std::move(outer), inner = std::move(inner), colour](const SurfacePoint& point) {
    return colour.shown(point.outside ? outer(point) : inner(point));
  };
}

Shader local_shader(const Vec3f& albedo) {
  return [albedo](const SurfacePoint& point) { return albedo * local_light(point); };
}

Shader normal_shader() {
  return [](const SurfacePoint& point) { return Vec3f(0.5 * (point.normal + 1.0)); };
}

}  // namespace isolux
