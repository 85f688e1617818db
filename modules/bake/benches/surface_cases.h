#pragma once

// The cases of the light's benches: 32^3 blocks of real volumes (ISOLUX_DATA names their folder; built-in fields
// otherwise), where their isosurfaces meet, and the light at random points of isosurfaces traced with many rays.
#include <isolux/core/field.h>
#include <isolux/core/random.h>
#include <isolux/raytrace_flat/flat_tracer.h>
#include <isolux/resample.h>
#include <isolux/sample_sites/site_sampler.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace isolux::bench {

inline constexpr int kBlock = 32;            // voxels an axis
inline constexpr int kReferenceRays = 1024;  // noise of .01
inline constexpr std::size_t kPoints = 500;  // an isosurface
// Likewise, where biases count. The median of absolute biases has a floor even for light without any: rms .018 at 500
// points makes it .0006, at so many .00014 (counter bias_floor).
inline constexpr std::size_t kManyPoints = 8192;

struct Source {
  std::string name;
  std::vector<float> isovalues;
};

inline std::vector<Source> sources() {
  const char* folder = std::getenv("ISOLUX_DATA");
  if (folder == nullptr) {
    return {{"gen:gyroid:32", {-0.5f, 0.0f, 0.5f}},
            {"gen:marschner-lobb:32", {0.3f, 0.5f, 0.7f}},
            {"gen:two-spheres:32", {-0.3f, -0.2f, -0.15f}}};
  }
  const std::string at = std::string(folder) + "/";
  return {{at + "neghip_64x64x64_uint8.raw", {40, 80, 150}},
          {at + "engine.nrrd", {60, 110, 180}},
          {at + "headsq_quarter.nrrd", {500, 1150, 1600}},
          {at + "stent.nrrd", {150, 300, 700}},
          {at + "fuel_64x64x64_uint8.raw", {10, 60, 120}},
          {at + "bonsai.nrrd", {40, 90, 150}},
          {at + "fetal_t2.nrrd", {120, 250, 400}},
          {at + "frog.nrrd", {40, 70, 110}},
          {at + "viscous_fingers.nrrd", {15, 30, 55}},
          {at + "brain1_anisotropic.nrrd", {150, 450, 1000}},
          {at + "blunt_fin.nrrd", {35, 60, 85}},
          {at + "hydrogen_atom_128x128x128_uint8.raw", {8, 20, 40}}};
}

inline ValueRange cell_range(const Volume& volume, const Index3& cell) {
  ValueRange range{.low = volume.values(cell.x, cell.y, cell.z), .high = volume.values(cell.x, cell.y, cell.z)};
  for (int q = 1; q < 8; ++q) {
    const float v = volume.values(cell.x + (q & 1), cell.y + (q >> 1 & 1), cell.z + (q >> 2));
    range = {.low = std::min(range.low, v), .high = std::max(range.high, v)};
  }
  return range;
}

inline bool crossed(const Volume& volume, const Index3& cell, float isovalue) {
  const ValueRange range = cell_range(volume, cell);
  return range.low < isovalue && isovalue < range.high;
}

/// The block where the isosurfaces cross the most cells, none of them forgotten.
inline Volume busiest_block(const Volume& volume, const std::vector<float>& isovalues) {
  const Index3 size = glm::min(Index3(kBlock), volume.lattice().size);
  const Index3 room = volume.lattice().size - size;
  Index3 best(0);
  double most = -1.0;
  for (int z = 0; z <= room.z; z += 8)
    for (int y = 0; y <= room.y; y += 8)
      for (int x = 0; x <= room.x; x += 8) {
        double score = 0.0;
        for (const float h : isovalues) {
          int cells = 0;
          for (int k = 2; k < size.z - 2; k += 2)
            for (int j = 2; j < size.y - 2; j += 2)
              for (int i = 2; i < size.x - 2; i += 2) cells += crossed(volume, {x + i, y + j, z + k}, h) ? 1 : 0;
          score += std::sqrt(double(cells));
        }
        if (score > most) std::tie(most, best) = std::make_tuple(score, Index3(x, y, z));
      }
  Volume block = volume;
  Lattice lattice{.size = size, .frame = volume.lattice().frame};
  lattice.frame.origin = volume.lattice().frame.world(Vec3(best));
  block.values = Grid<float>(lattice);
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i) block.values(i, j, k) = volume.values(best.x + i, best.y + j, best.z + k);
  return block;
}

/// So many texels a cell and axis.
inline Lattice texels_of(const Volume& volume, double a_cell) {
  return cell_lattice(volume.lattice(), Index3(glm::round(Vec3(volume.lattice().size - 1) * a_cell)));
}

/// Points of {f = isovalue} inside random crossed cells, found along the axis of the steepest change.
inline std::vector<Vec3f> surface_points(const Volume& volume, float isovalue, std::size_t count, std::uint64_t seed) {
  const TrilinearField field(volume);
  std::vector<Index3> cells;
  const Index3 size = volume.lattice().size;
  for (int k = 1; k < size.z - 2; ++k)
    for (int j = 1; j < size.y - 2; ++j)
      for (int i = 1; i < size.x - 2; ++i)
        if (crossed(volume, {i, j, k}, isovalue)) cells.emplace_back(i, j, k);
  std::vector<Vec3f> points;
  RandomStream random(seed, 0);
  for (std::size_t t = 0; t < 40 * count && points.size() < count && !cells.empty(); ++t) {
    const Index3 cell = cells[std::size_t(random.uniform_double() * double(cells.size()))];
    Vec3 p = Vec3(cell);
    for (int a = 0; a < 3; ++a) p[a] += random.uniform_double();
    const Vec3 g = field.cell_gradient(p);
    int axis = 0;
    for (int a = 1; a < 3; ++a) axis = std::fabs(g[a]) > std::fabs(g[axis]) ? a : axis;
    if (g[axis] == 0.0) continue;
    p[axis] += (double(isovalue) - field.value(p)) / g[axis];
    if (p[axis] > cell[axis] + 0.01 && p[axis] < cell[axis] + 0.99) points.emplace_back(p);
  }
  return points;
}

inline SampleSet trace(const Volume& volume, Sites sites, int rays, std::uint64_t seed,
                       RaySpread spread = RaySpread::kEven) {
  const Scene scene;
  return tracers()
      .create()
      ->trace(volume, scene, std::move(sites),
              {.rays = rays, .bounces = 0, .nets = RayNets::kInterleaved, .spread = spread}, {.seed = seed})
      .samples;
}

inline double percentile(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  return values[std::size_t(part * double(values.size() - 1))];
}

inline void append(SampleSet& all, const SampleSet& more) {
  const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  all.channels = more.channels;
  add(all.sites.positions, more.sites.positions);
  add(all.sites.isovalues, more.sites.isovalues);
  add(all.sites.normals, more.sites.normals);
  add(all.radiance, more.radiance);
  add(all.variance, more.variance);
}

/// What is read at references less what they are, by isosurface.
struct SurfaceErrors {
  std::vector<double> rms;
  std::vector<double> bias;
  std::vector<double> bias_deviation;  ///< standard error of each, by the points' number

  void add(const LightReader& reader, const SampleSet& reference) {
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t s = 0; s < reference.size(); ++s) {
      const auto isovalue = double(reference.sites.isovalues[s]);
      const double e =
          double(reader.at_index(Vec3(reference.sites.positions[s]), isovalue).x) - double(reference.radiance[s]);
      sum += e;
      squares += e * e;
    }
    const auto n = double(reference.size());
    rms.push_back(std::sqrt(squares / n));
    bias.push_back(std::fabs(sum / n));
    bias_deviation.push_back(std::sqrt(std::max(0.0, squares / n - std::pow(sum / n, 2.0)) / n));
  }

  /// The median of absolute biases to expect of light without any.
  [[nodiscard]] double bias_floor() const {
    constexpr double kMedianOfNormal = 0.6745;  // of the absolute value, in standard deviations
    return kMedianOfNormal * percentile(bias_deviation, 0.5);
  }
};

}  // namespace isolux::bench
