#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/core/random.h>
#include <isolux/render/render.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <optional>
#include <utility>

namespace isolux {
namespace {

/// Where a ray enters the box of a volume's grid points and where it leaves it.
struct BoxPassage {
  struct End {
    double t;    ///< in lengths of the direction
    Vec3 index;  ///< index space, exactly on the face
    int face;    ///< 2 axis, + 1 where the index is highest
  };
  std::optional<End> enter;  ///< none where it begins inside
  End leave;
};

/// Nothing if the ray misses the box.
std::optional<BoxPassage> pass_box(const Vec3& begin, const Vec3& direction, const Index3& size) {
  // Of a voxel: the plane that an orthographic camera's rays leave may touch the box, but for rounding.
  constexpr double kTouching = 1e-6;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const Vec3 last(size - 1);
  BoxPassage::End enter{.t = -kFar, .index = begin, .face = 0};
  BoxPassage::End leave{.t = kFar, .index = begin, .face = 0};
  for (int a = 0; a < 3; ++a) {
    if (direction[a] == 0.0) {
      if (begin[a] < 0.0 || begin[a] > last[a]) return std::nullopt;
      continue;
    }
    const int ahead = direction[a] > 0.0 ? 1 : 0;
    const double near = ((1 - ahead) * last[a] - begin[a]) / direction[a];
    const double far = (ahead * last[a] - begin[a]) / direction[a];
    if (near > enter.t) enter = {.t = near, .index = begin, .face = 2 * a + 1 - ahead};
    if (far < leave.t) leave = {.t = far, .index = begin, .face = 2 * a + ahead};
  }
  if (!(enter.t <= leave.t) || !(leave.t >= 0.0) || leave.t == kFar) return std::nullopt;
  for (BoxPassage::End* end : {&enter, &leave}) {
    const int axis = end->face / 2;
    end->index = glm::clamp(begin + end->t * direction, Vec3(0.0), last);
    end->index[axis] = end->face % 2 * last[axis];
  }
  const bool from_outside = enter.t * std::fabs(direction[enter.face / 2]) > -kTouching;
  return BoxPassage{.enter = from_outside ? std::optional(enter) : std::nullopt, .leave = leave};
}

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
        world_to_index_(glm::inverse(field.lattice().frame.axes)),
        cap_side_(settings.only.value_or(LevelSetSide::kOuter)) {}

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
  /// A place of the surface or its cap.
  struct Place {
    Vec3 index;
    LevelSetSide side;  ///< that the camera sees
    std::optional<int> cap{};
  };

  /// What the surface sends along the ray through a point of the picture; nothing where there is none.
  [[nodiscard]] std::optional<Vec3f> radiance(double x, double y) const {
    const Vec3 direction = camera_.direction(x, y);
    const Vec3 begin = field_.lattice().frame.index(camera_.origin(x, y));
    const auto place = first_shown(begin, world_to_index_ * direction);
    if (!place) return std::nullopt;
    SurfacePoint point;
    point.index = place->index;
    point.world = field_.lattice().frame.world(place->index);
    point.normal =
        place->cap ? cap_normal(*place->cap) : field_.normal(place->index, settings_.outer, settings_.gradient);
    point.towards_eye = -direction;
    point.outside = place->side == LevelSetSide::kOuter;
    point.cap = place->cap;
    return shader_(point);
  }

  /// The first place on the way that the settings show.
  [[nodiscard]] std::optional<Place> first_shown(const Vec3& begin, const Vec3& direction) const {
    std::optional<BoxPassage> passage;
    if (settings_.cap) passage = pass_box(begin, direction, field_.lattice().size);
    if (passage && passage->enter) {
      const Place entry = cap_place(*passage->enter, cap_side_);
      if (is_closed(entry.index) && is_shown(entry)) return entry;
    }
    auto hit = intersector_.first_hit(begin, direction, settings_.isovalue);
    LevelSetSide side = hit ? side_seen(hit->position, direction) : LevelSetSide::kOuter;
    // A line meets the level set at most three times a cell, so this ends whatever roundings do.
    const Index3& size = field_.lattice().size;
    for (int most = 3 * (size.x + size.y + size.z); hit && most > 0; --most) {
      const Place place{.index = hit->position, .side = side};
      if (is_shown(place)) return place;
      // Beyond it the ray is on the other side of the level set and meets it from there next.
      const bool was_outside = side == LevelSetSide::kOuter;
      hit = intersector_.next_hit(hit->position, direction, settings_.isovalue,
                                  was_outside ? opposite(settings_.outer) : settings_.outer);
      side = was_outside ? LevelSetSide::kInner : LevelSetSide::kOuter;
    }
    if (!passage) return std::nullopt;
    const bool is_outer = cap_side_ == LevelSetSide::kOuter;
    const Place exit = cap_place(passage->leave, is_outer ? LevelSetSide::kInner : LevelSetSide::kOuter);
    if (is_closed(exit.index) && is_shown(exit)) return exit;
    return std::nullopt;
  }

  [[nodiscard]] bool is_shown(const Place& place) const {
    if (settings_.only && place.side != *settings_.only) return false;
    return !settings_.left_out || !settings_.left_out(place.index);
  }

  [[nodiscard]] static Place cap_place(const BoxPassage::End& end, LevelSetSide side) {
    return {.index = end.index, .side = side, .cap = end.face};
  }

  /// Whether a place on the box's faces belongs to what a cap closes. The isovalue itself counts as just inside, as for
  /// meshes.
  [[nodiscard]] bool is_closed(const Vec3& index) const {
    const double above = field_.value(index) - double(settings_.isovalue);
    const bool has_higher = (settings_.outer == OuterSide::kLower) == (cap_side_ == LevelSetSide::kOuter);
    return has_higher ? above >= 0.0 : above <= 0.0;
  }

  /// Towards the outer side.
  [[nodiscard]] Vec3 cap_normal(int face) const {
    const Vec3 upwards = glm::normalize(field_.lattice().frame.gradient_to_world()[face / 2]);
    const bool is_along = (face % 2 == 1) == (cap_side_ == LevelSetSide::kOuter);
    return is_along ? upwards : -upwards;
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
  LevelSetSide cap_side_;  ///< the side of a cap that is seen from outside the box
};

/// A headlight over the viewer's shoulder and a sky of half its strength.
float local_light(const SurfacePoint& point) {
  const Vec3 n = point.outside ? point.normal : -point.normal;
  const Vec3 sky(0.0, 0.0, 1.0);
  const double head = std::max(0.0, glm::dot(n, point.towards_eye));
  return float(0.7 * head + 0.15 * (1.0 + glm::dot(n, sky)));
}

/// What has no light of its own.
Vec3f dim(const SurfacePoint& point, const SurfaceColour& colour) {
  return colour.albedo * (0.1f * local_light(point));
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
    return point.outside ? colour.shown(light(point)) : dim(point, colour);
  };
}

Shader global_shader(LightAt outer, LightAt inner, const SurfaceColour& colour) {
  return [outer = std::move(outer), inner = std::move(inner), colour](const SurfacePoint& point) {
    if (point.outside) return colour.shown(outer(point));
    return point.cap ? dim(point, colour) : colour.shown(inner(point));
  };
}

Shader local_shader(const Vec3f& albedo) {
  return [albedo](const SurfacePoint& point) { return albedo * local_light(point); };
}

Shader normal_shader() {
  return [](const SurfacePoint& point) { return Vec3f(0.5 * (point.normal + 1.0)); };
}

}  // namespace isolux
