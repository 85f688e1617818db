// Is few rays' light, fitted, as good as many rays' at the texels, at the edges of shadows too, and does light leak
// through thin walls? Every scheme lights all level sets of a scene; e is read at random points of some and compared
// with 1024 rays there, or with the exact answer where there is one. Counters, means of the seeds 5 to 8 of sites and
// rays: rms error and bias where light changes slowly, rms error within 1.5 voxels of a shadow's edge.
#include <benchmark/benchmark.h>

#include <array>
#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "surface_cases.h"

namespace {

using namespace isolux;
using namespace isolux::bench;

/// A scene on the unit cube, what is known of its light, and where the edges of its shadows are.
struct Subject {
  Volume volume;
  Scene scene;
  std::vector<float> isovalues;
  std::function<double(const Vec3&)> exact;  ///< of world points; empty: traced
  std::function<bool(const Vec3&)> on_edge;  ///< of world points; empty: nowhere
};

Subject half_lit_ball() {
  Subject s{.volume = read_volume("gen:sphere:32"),
            .scene = {},
            .isovalues = {-0.2f, -0.3f, -0.4f},
            .exact = {},
            .on_edge = {}};
  s.scene.environment = SkyEnvironment{.zenith = Vec3f(1.0f), .horizon = Vec3f(1.0f), .ground = Vec3f(0.0f)};
  s.exact = [](const Vec3& p) { return 0.5 + 0.5 * glm::normalize(p - Vec3(0.5)).z; };
  return s;
}

Subject two_balls() {
  return {.volume = read_volume("gen:two-spheres:32"),
          .scene = {},
          .isovalues = {-0.1f, -0.15f, -0.19f},
          .exact = {},
          .on_edge = {}};
}

Subject ball_in_the_sun() {
  Subject s{.volume = read_volume("gen:ball-over-plane:48"),
            .scene = {},
            .isovalues = {-0.05f, -0.1f, -0.15f},
            .exact = {},
            .on_edge = {}};
  const Vec3 sun = glm::normalize(Vec3(0.2, 0.1, 1.0));
  s.scene.environment = UniformEnvironment{.radiance = Vec3f(0.2f)};
  s.scene.lights = {SunLight{.direction = Vec3f(sun), .irradiance = Vec3f(2.5f)}};
  s.on_edge = [sun](const Vec3& p) {
    // On the plane z = -h a point is in the shadow of the ball of radius .1 - h.
    const Vec3 to_centre = Vec3(0.5) - p;
    const double beside = glm::length(to_centre - glm::dot(to_centre, sun) * sun);
    return std::fabs(beside - (0.1 + p.z)) < 1.5 / 47.0;
  };
  return s;
}

/// A ridge of two sheets, the upper one in the light, the lower one in the dark, as far apart as twice the isovalues.
Subject sheets(std::vector<float> isovalues) {
  Subject s{.volume = read_volume("gen:sphere:32"),
            .scene = {},
            .isovalues = std::move(isovalues),
            .exact = {},
            .on_edge = {}};
  const auto height = [](const Vec3& index) { return index.z - 15.3 - 0.13 * (index.x - 15.0); };
  for (int k = 0; k < 32; ++k)
    for (int j = 0; j < 32; ++j)
      for (int i = 0; i < 32; ++i) s.volume.values(i, j, k) = -float(std::fabs(height(Vec3(i, j, k))));
  s.scene.environment = SkyEnvironment{
      .up = Vec3f(-0.13f, 0.0f, 1.0f), .zenith = Vec3f(1.0f), .horizon = Vec3f(1.0f), .ground = Vec3f(0.0f)};
  return s;
}

Subject two_sheets() { return sheets({-0.95f, -0.75f}); }

/// Closer than a voxel the interpolant has no two sheets: it falls apart into pods around the voxels next to the ridge.
Subject within_a_voxel() { return sheets({-0.6f, -0.4f, -0.25f}); }

struct Truth {
  SampleSet points;
  std::vector<std::uint8_t> on_edge;
};

SampleSet trace_in(const Subject& subject, Sites sites, int rays, std::uint64_t seed,
                   LampLight lamps = LampLight::kWithin, RaySpread spread = RaySpread::kEven) {
  const TraceSettings settings{
      .rays = rays, .bounces = 0, .nets = RayNets::kInterleaved, .lamps = lamps, .spread = spread};
  return tracers().create()->trace(subject.volume, subject.scene, std::move(sites), settings, {.seed = seed}).samples;
}

Truth truth_of(const Subject& subject) {
  std::vector<Vec3f> points;
  for (const float h : subject.isovalues) {
    const std::vector<Vec3f> more = surface_points(subject.volume, h, 2000, 11);
    points.insert(points.end(), more.begin(), more.end());
  }
  Truth truth{.points = trace_in(subject, make_sites(subject.volume, std::move(points), {}, {}), kReferenceRays, 77),
              .on_edge = {}};
  for (std::size_t i = 0; i < truth.points.size(); ++i) {
    const Vec3 world = subject.volume.lattice().frame.world(Vec3(truth.points.sites.positions[i]));
    if (subject.exact) truth.points.radiance[i] = float(subject.exact(world));
    truth.on_edge.push_back(subject.on_edge && subject.on_edge(world) ? 1 : 0);
  }
  return truth;
}

struct Scheme {
  std::string sampler;
  double sites;  ///< a texel
  int rays;
  std::string resampler;
  Settings settings;
  double texels = 1;  ///< a cell and axis
};

/// What is read less the truth, away from shadows' edges and on them.
struct Errors {
  std::array<double, 2> sum{};
  std::array<double, 2> squares{};
  std::array<double, 2> count{};

  [[nodiscard]] double rms(std::size_t kind) const { return std::sqrt(squares[kind] / count[kind]); }
};

Errors errors_of(const Subject& subject, const Truth& truth, const Scheme& scheme, std::uint64_t seed) {
  const Lattice texels = texels_of(subject.volume, scheme.texels);
  const SiteRequest request{.texels = texels, .per_texel = scheme.sites};
  const auto resampler = resamplers().create(scheme.resampler, scheme.settings);
  const SampleSet samples =
      trace_in(subject, samplers().create(scheme.sampler)->sample(subject.volume, request, {.seed = seed}), scheme.rays,
               seed, resampler->lamps(), resampler->spread());
  const IlluminationGrid light = fill_unlit(resampler->resample(subject.volume, samples, texels, {}), {});
  const LightReader reader(subject.volume, light);
  Errors errors;
  for (std::size_t i = 0; i < truth.points.size(); ++i) {
    const Sites& at = truth.points.sites;
    const double e = double(reader.at_index(Vec3(at.positions[i]), double(at.isovalues[i])).x);
    const double d = e - double(truth.points.radiance[i]);
    errors.sum[truth.on_edge[i]] += d;
    errors.squares[truth.on_edge[i]] += d * d;
    errors.count[truth.on_edge[i]] += 1.0;
  }
  return errors;
}

void edges(benchmark::State& state, const std::function<Subject()>& make, const Scheme& scheme) {
  const Subject subject = make();
  const Truth truth = truth_of(subject);
  constexpr std::array<std::uint64_t, 4> kSeeds{5, 6, 7, 8};
  constexpr double kShare = 1.0 / double(kSeeds.size());
  double smooth = 0.0;
  double bias = 0.0;
  double edge = 0.0;
  for (auto _ : state) {
    for (const std::uint64_t seed : kSeeds) {
      const Errors errors = errors_of(subject, truth, scheme, seed);
      smooth += kShare * errors.rms(0);
      bias += kShare * errors.sum[0] / errors.count[0];
      if (errors.count[1] > 0.0) edge += kShare * errors.rms(1);
    }
  }
  state.counters["smooth"] = smooth;
  state.counters["bias"] = bias;
  if (edge > 0.0) state.counters["edge"] = edge;
}

const int kRegistered = [] {
  const std::vector<std::pair<std::string, std::function<Subject()>>> subjects{{"half_lit_ball", half_lit_ball},
                                                                               {"two_balls", two_balls},
                                                                               {"ball_in_the_sun", ball_in_the_sun},
                                                                               {"two_sheets", two_sheets},
                                                                               {"within_a_voxel", within_a_voxel}};
  const Settings denoise{{"denoise", "true"}};
  const Settings no_normals{{"normals", "false"}};
  const std::vector<std::pair<std::string, Scheme>> schemes{
      {"texels_16", {"texels", 1, 16, "direct", {}}},
      {"texels_16_denoised", {"texels", 1, 16, "direct", denoise}},
      {"texels_16_denoised_blunt", {"texels", 1, 16, "direct", {{"denoise", "true"}, {"sharpen", "false"}}}},
      {"texels_16_denoised_even", {"texels", 1, 16, "direct", {{"denoise", "true"}, {"spread", "false"}}}},
      {"texels_128", {"texels", 1, 128, "direct", {}}},
      {"texels_128_denoised", {"texels", 1, 128, "direct", denoise}},
      {"fit_no_normals_4x4", {"stratified", 4, 4, "fit", no_normals}},
      {"fit_no_normals_8x16", {"stratified", 8, 16, "fit", no_normals}},
      {"fit_4x4", {"stratified", 4, 4, "fit", {}}},
      {"fit_8x16", {"stratified", 8, 16, "fit", {}}},
      {"fit_8x16_0.73_an_axis", {"stratified", 20.6, 16, "fit", {}, 0.73}}};
  for (const auto& [subject, make] : subjects) {
    for (const auto& [name, scheme] : schemes) {
      benchmark::RegisterBenchmark(("edges/" + subject + "/" + name).c_str(), edges, make, scheme)
          ->Unit(benchmark::kMillisecond)
          ->Iterations(1);
    }
  }
  return int(schemes.size());
}();

}  // namespace
