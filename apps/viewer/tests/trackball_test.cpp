#include "camera/trackball.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "camera/framing.h"

namespace isolux::viewer {
namespace {

const Lattice kVolume{.size = {11, 21, 31}, .frame = {.origin = {100.0, -50.0, 7.0}, .axes = Mat3(1.0)}};

Trackball make_trackball() {
  return {orbit_camera(kVolume, 30.0, 20.0, 1.0), box_middle(kVolume), box_radius(kVolume)};
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "axis " << i;
}

/// Where the camera shows a world point, in a square picture.
glm::dvec2 shown_at(const Camera& camera, const Vec3& world) {
  const Vec3 way = world - camera.eye;
  const double depth = glm::dot(way, camera.forward);
  return {glm::dot(way, camera.right) / (depth * camera.half_height),
          glm::dot(way, camera.up) / (depth * camera.half_height)};
}

// Double rounding of coordinates of some hundred units through a dozen products.
constexpr double kRounding = 1e-10;

TEST(Trackball, StartsAtHomeAndReturnsThere) {
  Trackball trackball = make_trackball();
  const Camera home = orbit_camera(kVolume, 30.0, 20.0, 1.0);
  expect_near(trackball.camera().eye, home.eye, kRounding);
  expect_near(trackball.camera().forward, home.forward, kRounding);
  trackball.rotate({0.1, 0.2}, {-0.7, 0.4});
  trackball.pan({0.0, 0.0}, {0.3, 0.3});
  trackball.zoom(5.0);
  EXPECT_GT(glm::length(trackball.camera().eye - home.eye), 1.0);
  trackball.reset();
  expect_near(trackball.camera().eye, home.eye, kRounding);
  expect_near(trackball.camera().up, home.up, kRounding);
}

TEST(Trackball, KeepsItsAxesAtRightAnglesAndItsDistance) {
  Trackball trackball = make_trackball();
  const double distance = glm::length(trackball.camera().eye - box_middle(kVolume));
  for (int i = 0; i < 2000; ++i) trackball.rotate({0.9 * std::sin(i), 0.2}, {0.3, 1.2 * std::cos(3.0 * i)});
  const Camera camera = trackball.camera();
  expect_near(glm::cross(camera.right, camera.up), -camera.forward, kRounding);
  EXPECT_NEAR(glm::length(camera.right), 1.0, kRounding);
  EXPECT_NEAR(glm::length(camera.eye - box_middle(kVolume)), distance, kRounding);
}

TEST(Trackball, TurnsTheNearSideWithTheMouse) {
  Trackball trackball = make_trackball();
  const Camera before = trackball.camera();
  const Vec3 near_point = box_middle(kVolume) - before.forward;
  trackball.rotate({0.0, 0.0}, {0.2, 0.0});
  EXPECT_GT(shown_at(trackball.camera(), near_point).x, 1e-3);
  EXPECT_NEAR(shown_at(trackball.camera(), near_point).y, 0.0, kRounding);
  trackball.reset();
  trackball.rotate({0.0, 0.0}, {0.0, 0.2});
  EXPECT_GT(shown_at(trackball.camera(), near_point).y, 1e-3);
}

TEST(Trackball, TurnsBackOnTheSameWay) {
  Trackball trackball = make_trackball();
  trackball.rotate({0.1, 0.2}, {-0.7, 0.4});
  trackball.rotate({-0.7, 0.4}, {0.1, 0.2});
  expect_near(trackball.camera().eye, make_trackball().camera().eye, kRounding);
}

TEST(Trackball, RollsOutsideTheBall) {
  Trackball trackball = make_trackball();
  const Vec3 forward = trackball.camera().forward;
  // Far from the middle the hyperbolic sheet is almost flat: a turn round it hardly tilts.
  trackball.rotate({50.0, 0.0}, {0.0, 50.0});
  EXPECT_GT(glm::dot(trackball.camera().forward, forward), 0.999);
  EXPECT_NEAR(glm::dot(trackball.camera().up, make_trackball().camera().up), 0.0, 0.01);
}

TEST(Trackball, PansThePointOfTheBoxsMiddleWithTheMouse) {
  Trackball trackball = make_trackball();
  trackball.rotate({0.1, 0.2}, {-0.7, 0.4});
  trackball.pan({0.1, -0.2}, {0.45, 0.3});
  const glm::dvec2 shown = shown_at(trackball.camera(), box_middle(kVolume));
  EXPECT_NEAR(shown.x, 0.35, kRounding);
  EXPECT_NEAR(shown.y, 0.5, kRounding);
}

TEST(Trackball, ZoomsWithinBounds) {
  Trackball trackball = make_trackball();
  const double radius = box_radius(kVolume);
  const auto distance = [&] { return glm::length(trackball.camera().eye - box_middle(kVolume)); };
  const double start = distance();
  trackball.zoom(1.0);
  EXPECT_NEAR(distance(), 0.9 * start, kRounding);
  trackball.zoom(1e4);
  EXPECT_NEAR(distance(), radius / 50.0, kRounding);
  trackball.zoom(-1e4);
  EXPECT_NEAR(distance(), radius * 50.0, 1e-6);
}

TEST(Trackball, KeepsWhatTheMouseDidForAPictureOfAnotherShape) {
  Trackball trackball = make_trackball();
  trackball.rotate({0.1, 0.2}, {-0.7, 0.4});
  trackball.pan({0.0, 0.0}, {0.3, 0.3});
  trackball.zoom(3.0);
  const Camera before = trackball.camera();
  trackball.reframe(orbit_camera(kVolume, 30.0, 20.0, 0.25));
  const double farther = glm::length(trackball.camera().eye - before.eye);
  EXPECT_GT(farther, 1.0) << "a narrow picture is taken from farther off";
  expect_near(trackball.camera().forward, before.forward, kRounding);
  expect_near(trackball.camera().eye, before.eye - farther * before.forward, kRounding);
  trackball.reframe(orbit_camera(kVolume, 30.0, 20.0, 1.0));
  expect_near(trackball.camera().eye, before.eye, kRounding);
}

/// The box's corners in clip space.
std::vector<glm::dvec4> shown_corners(const Camera& camera, double aspect, const Lattice& volume = kVolume) {
  const Vec3 middle = box_middle(volume);
  const glm::dmat4 clip = clip_from_centred(camera, middle, box_radius(volume), aspect);
  std::vector<glm::dvec4> corners;
  for (int corner = 0; corner < 8; ++corner) {
    const Index3 far_side(corner & 1, corner >> 1 & 1, corner >> 2);
    corners.push_back(clip * glm::dvec4(volume.frame.world(Vec3(far_side * (volume.size - 1))) - middle, 1.0));
  }
  return corners;
}

TEST(Framing, ShowsTheWholeBoxAtTheStartInEveryPicture) {
  for (const double aspect : {0.3, 1.0, 2.5}) {
    for (const glm::dvec4& p : shown_corners(orbit_camera(kVolume, 30.0, 20.0, aspect), aspect)) {
      EXPECT_LE(std::fabs(p.x), p.w * (1.0 + kRounding));
      EXPECT_LE(std::fabs(p.y), p.w * (1.0 + kRounding));
    }
  }
}

TEST(Framing, ShowsWhatTheRaycasterShowsInThatPlace) {
  for (const double aspect : {0.3, 1.0, 2.5}) {
    const Camera camera = orbit_camera(kVolume, 30.0, 20.0, aspect);
    const Vec3 middle = box_middle(kVolume);
    const glm::dmat4 clip = clip_from_centred(camera, middle, box_radius(kVolume), aspect);
    const glm::dvec2 place(-0.7 * aspect, 0.4);
    const Vec3 seen = camera.eye + 30.0 * camera.direction(place.x, place.y);
    const glm::dvec4 p = clip * glm::dvec4(seen - middle, 1.0);
    EXPECT_NEAR(p.x / p.w, place.x / aspect, kRounding);
    EXPECT_NEAR(p.y / p.w, place.y, kRounding);
  }
}

TEST(Framing, IsTheSameForABoxOfAnySize) {
  const std::vector<glm::dvec4> corners = shown_corners(orbit_camera(kVolume, 30.0, 20.0, 1.5), 1.5);
  for (const double length : {1e-30, 1e17, 1e36}) {
    Lattice volume = kVolume;
    volume.frame = {.origin = length * volume.frame.origin, .axes = length * volume.frame.axes};
    const auto scaled = shown_corners(orbit_camera(volume, 30.0, 20.0, 1.5), 1.5, volume);
    for (std::size_t i = 0; i < corners.size(); ++i)
      expect_near(Vec3(scaled[i]) / scaled[i].w, Vec3(corners[i]) / corners[i].w, kRounding);
  }
}

TEST(Framing, KeepsTheBoxBetweenTheNearAndTheFarPlaneFromEverywhere) {
  Trackball trackball = make_trackball();
  for (int turn = 0; turn < 50; ++turn) {
    trackball.rotate({0.0, 0.0}, {0.5 * std::sin(turn), 0.4});
    for (const glm::dvec4& p : shown_corners(trackball.camera(), 1.5)) EXPECT_LE(std::fabs(p.z), p.w * (1.0 + 1e-9));
  }
}

}  // namespace
}  // namespace isolux::viewer
