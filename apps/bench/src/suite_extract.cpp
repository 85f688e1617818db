#include <fmt/format.h>
#include <isolux/mc_extract/iso_extractor.h>
#include <isolux/mc_extract/measure_mesh.h>
#include <isolux/volume_io/analytic_fields.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "extract_many.h"
#include "peer_vtk.h"
#include "stats.h"
#include "suites.h"

namespace isolux::bench {
namespace {

constexpr double kRadius = 0.3;       // of the sphere
constexpr double kTubeRadius = 0.12;  // of the torus, whose circle has radius .28

/// A closed surface with known distance, area, volume and Euler number.
struct Shape {
  std::string name;
  std::string field;
  float isovalue;
  double area;
  double volume;
  double euler;
  std::function<double(const Vec3&)> distance;  ///< signed, outside positive
  std::function<Vec3(const Vec3&)> normal;
};

std::vector<Shape> shapes() {
  const double pi = std::numbers::pi;
  const auto to_circle = [](const Vec3& p) {
    const Vec3 q = p - Vec3(0.5);
    const double across = std::sqrt(q.x * q.x + q.y * q.y);
    return q - Vec3(q.x, q.y, 0.0) * (0.28 / across);
  };
  return {
      {"sphere", "sphere", float(-kRadius), 4.0 * pi * kRadius * kRadius, 4.0 / 3.0 * pi * kRadius * kRadius * kRadius,
       2.0, [](const Vec3& p) { return glm::length(p - Vec3(0.5)) - kRadius; },
       [](const Vec3& p) { return glm::normalize(p - Vec3(0.5)); }},
      {"torus", "torus", float(-kTubeRadius), 4.0 * pi * pi * 0.28 * kTubeRadius,
       2.0 * pi * pi * 0.28 * kTubeRadius * kTubeRadius, 0.0,
       [to_circle](const Vec3& p) { return glm::length(to_circle(p)) - kTubeRadius; },
       [to_circle](const Vec3& p) { return glm::normalize(to_circle(p)); }}};
}

Vec3 vec(const IsoMesh::Point& p) { return {p[0], p[1], p[2]}; }

struct Geometry {
  double rms_distance = 0.0;
  double largest_distance = 0.0;  ///< from vertices and middles of triangles to the surface
  double rms_angle = 0.0;         ///< degrees, of vertex normals
};

Geometry geometry_error(const IsoMesh& mesh, const Shape& shape) {
  std::vector<double> distances;
  std::vector<double> angles;
  for (const auto vertex : mesh.vertices()) {
    const Vec3 p = vec(mesh.point(vertex));
    const auto& n = mesh.normal(vertex);
    distances.push_back(shape.distance(p));
    angles.push_back(std::acos(std::clamp(glm::dot(Vec3(n[0], n[1], n[2]), shape.normal(p)), -1.0, 1.0)) * 180.0 /
                     std::numbers::pi);
  }
  for (const auto face : mesh.faces()) {
    Vec3 middle(0.0);
    for (const auto vertex : face.vertices()) middle += vec(mesh.point(vertex)) / 3.0;
    distances.push_back(shape.distance(middle));
  }
  Geometry result{.rms_distance = rms(distances), .rms_angle = rms(angles)};
  for (const double d : distances) result.largest_distance = std::max(result.largest_distance, std::fabs(d));
  return result;
}

void accuracy(const SuiteContext& context, SuiteReport& report) {
  Table table{.id = "accuracy",
              .title = "Geometric error",
              .columns = {"surface", "backend", "n", "triangles", "ms", "rms distance",
                          "largest distance (Hausdorff, from the mesh)", "rms normal angle, deg", "area error",
                          "volume error", "Euler number", "expected"},
              .sentence =
                  "Distances from vertices and middles of triangles to the analytic surface in the unit cube, relative "
                  "errors of area and volume."};
  Table rates{
      .id = "rates",
      .title = "Fitted rates",
      .columns = {"surface", "backend", "rms distance falls as", "+- (95 %)", "area error falls as", "+- (95 %) "},
      .sentence =
          "Least squares in logarithms over n, +- half the 95 % interval; linear interpolation is of second order."};
  Plot plot{.id = "distance",
            .title = "Distance to the analytic surface against time",
            .x_label = "ms",
            .y_label = "rms distance"};
  plot.sentence =
      "Along a curve n doubles: what accuracy a millisecond of extraction buys; bars are quartiles of the time's "
      "repetitions.";
  const std::vector<int> sizes = context.pick<std::vector<int>>({16, 24}, {16, 32, 64, 128}, {16, 32, 64, 128, 256});
  for (const Shape& shape : shapes()) {
    for (const BackendInfo& info : context.stages.extractors.backends()) {
      if (!info.unavailable.empty()) continue;
      const auto extractor = context.stages.extractors.create(info.name);
      Series series{.name = fmt::format("{}, {}", shape.name, info.name), .points = {}};
      std::vector<double> ns;
      std::vector<double> distances;
      std::vector<double> areas;
      for (const int n : sizes) {
        const Volume volume = sample_analytic_field(shape.field, n);
        IsoMesh mesh;
        const Estimate seconds =
            timed([&] { mesh = extractor->extract(volume, {.isovalue = shape.isovalue}, context.run); }, 5, 2.0);
        const Geometry geometry = geometry_error(mesh, shape);
        const MeshMeasures measures = measure_mesh(mesh);
        const double area_error = std::fabs(measures.area / shape.area - 1.0);
        table.rows.push_back({shape.name, info.name, double(n), double(mesh.n_faces()), 1e3 * seconds.value,
                              geometry.rms_distance, geometry.largest_distance, geometry.rms_angle, area_error,
                              std::fabs(measures.volume.value_or(0.0) / shape.volume - 1.0),
                              double(measures.euler_number), shape.euler});
        if (double(measures.euler_number) != shape.euler) {
          report.failures.push_back(
              fmt::format("{} of {}^3 by {} has Euler number {}", shape.name, n, info.name, measures.euler_number));
        }
        series.points.push_back({.x = 1e3 * seconds.value,
                                 .y = geometry.rms_distance,
                                 .left = 1e3 * seconds.low,
                                 .right = 1e3 * seconds.high});
        ns.push_back(double(n - 1));
        distances.push_back(geometry.rms_distance);
        areas.push_back(area_error);
      }
      const PowerLaw distance = fit_power_law(ns, distances);
      const PowerLaw area = fit_power_law(ns, areas);
      rates.rows.push_back({shape.name, info.name, fmt::format("n^{:.2f}", distance.exponent), bar_text(distance),
                            fmt::format("n^{:.2f}", area.exponent), bar_text(area)});
      plot.series.push_back(std::move(series));
    }
  }
  report.figures.emplace_back(std::move(plot));
  report.figures.emplace_back(std::move(rates));
  report.figures.emplace_back(std::move(table));
}

/// OpenMesh as its tutorial builds a mesh: add_vertex, add_face, update_normals.
Estimate openmesh_seconds(const IsoMesh& mesh) {
  return timed(
      [&] {
        IsoMesh copy;
        copy.reserve(mesh.n_vertices(), mesh.n_edges(), mesh.n_faces());
        copy.request_face_normals();
        for (const auto vertex : mesh.vertices()) copy.add_vertex(mesh.point(vertex));
        for (const auto face : mesh.faces()) {
          auto corner = mesh.cfv_ccwbegin(face);
          const auto a = *corner++;
          const auto b = *corner++;
          copy.add_face(a, b, *corner);
        }
        copy.update_normals();
      },
      3, 3.0);
}

/// The default backend beside VTK at the largest size that both were measured at.
std::string beside_flying_edges(const Plot& plot, const std::string& ours) {
  const auto named = [&](const std::string& name) {
    return std::find_if(plot.series.begin(), plot.series.end(), [&](const Series& s) { return s.name == name; });
  };
  const auto mine = named(ours);
  const auto vtk = named("VTK Flying Edges");
  if (vtk->points.empty()) return "VTK is not in this build: no comparison.";
  const PlotPoint& a = mine->points.back();
  const PlotPoint& b = vtk->points.back();
  return fmt::format("gen:gyroid:{} takes `{}`, half-edge mesh and normals included, {} ms; VTK's Flying Edges {} ms.",
                     number_text(a.x), ours, number_text(a.y), number_text(b.y));
}

void speed(const SuiteContext& context, SuiteReport& report) {
  Plot plot{.id = "speed", .title = "Extraction of gen:gyroid at 0", .x_label = "grid points an axis", .y_label = "ms"};
  plot.sentence =
      "With normals, all on the same number of threads; OpenMesh's own add_face and update_normals is given the "
      "finished triangles. Bars are quartiles.";
  const int threads = context.run.threads > 0 ? context.run.threads : 2;
  Run run = context.run;
  run.threads = threads;
  std::vector<Series> curves;
  std::vector<std::string> names;
  for (const BackendInfo& info : context.stages.extractors.backends()) {
    if (!info.unavailable.empty()) continue;
    names.push_back(info.name);
    curves.push_back({info.name, {}});
  }
  Series kept{.name = "IsoExtractor, indexed mesh, kept memory", .points = {}};
  Series vtk{.name = "VTK Flying Edges", .points = {}};
  Series own{.name = "OpenMesh add_face + update_normals", .points = {}};
  const auto add = [](Series& series, int n, const Estimate& s) {
    series.points.push_back({double(n), 1e3 * s.value, 1e3 * s.low, 1e3 * s.high});
  };
  const std::vector<int> sizes = context.pick<std::vector<int>>({16, 24}, {32, 64, 128}, {32, 64, 128, 256, 512});
  for (const int n : sizes) {
    context.say(fmt::format("gyroid {}", n));
    const Volume volume = sample_analytic_field("gyroid", n);
    IsoMesh mesh;
    for (std::size_t i = 0; i < names.size(); ++i) {
      // The others make meshes of several gigabytes there.
      if (n > 256 && names[i] != context.stages.extractors.info({}).name) continue;
      const auto extractor = context.stages.extractors.create(names[i]);
      add(curves[i], n, timed([&] { mesh = extractor->extract(volume, {}, run); }, 7, 3.0));
    }
    IsoExtractor extractor(volume, run);
    IndexedMesh indexed;
    extractor.extract({}, run, indexed);
    add(kept, n, timed([&] { extractor.extract({}, run, indexed); }, 7, 3.0));
    const auto values = volume.values.values();
    const VtkExtraction peer = vtk_flying_edges({values.begin(), values.end()}, n, 0.0f, threads, 5);
    if (!peer.seconds.empty()) add(vtk, n, median(peer.seconds));
    if (n <= 256) add(own, n, openmesh_seconds(context.stages.extractors.create()->extract(volume, {}, run)));
  }
  for (Series& curve : curves) plot.series.push_back(std::move(curve));
  plot.series.push_back(std::move(kept));
  plot.series.push_back(std::move(vtk));
  plot.series.push_back(std::move(own));
  report.highlights.push_back(beside_flying_edges(plot, context.stages.extractors.info({}).name));
  report.figures.emplace_back(std::move(plot));
}

}  // namespace

SuiteReport run_extract(const SuiteContext& context) {
  SuiteReport report;
  speed(context, report);
  report.figures.emplace_back(extract_many(context));
  accuracy(context, report);
  return report;
}

}  // namespace isolux::bench
