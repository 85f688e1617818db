#include "resample_error.h"

#include <isolux/resample/fill_unlit.h>
#include <isolux/resample/light_reader.h>

namespace isolux::bench {

ProbePoints probe_points(const Truth& truth, const Volume& volume, std::size_t count, const SuiteContext& context) {
  const double near = 1.5 / double(volume.lattice().size.x - 1);
  const Sites sites = known_sites(truth, volume, "random", count, context);
  ProbePoints points;
  for (const Vec3f& p : sites.positions) {
    const Vec3 world = volume.lattice().frame.world(Vec3(p));
    points.index.push_back(p);
    points.e.push_back(truth.light(world));
    points.near_edge.push_back(truth.edge && truth.edge(world) < near ? 1 : 0);
  }
  return points;
}

ResamplingResult resampling_error(const ProbePoints& points, const Volume& volume, const SampleSet& samples,
                                  const Resampler& resampler, const SuiteContext& context) {
  const Lattice texels = cell_lattice(volume.lattice());
  ResampledGrid partial;
  ResamplingResult found;
  found.seconds = timed([&] { partial = resampler.resample(volume, samples, texels, context.run); }, 3, 0.3);
  const IlluminationGrid light = fill_unlit(std::move(partial), context.run);
  const LightReader reader(volume, light);
  std::vector<double> all;
  std::vector<double> edge;
  std::vector<double> smooth;
  for (std::size_t i = 0; i < points.index.size(); ++i) {
    all.push_back(double(reader.at_index(Vec3(points.index[i])).x) - points.e[i]);
    (points.near_edge[i] != 0 ? edge : smooth).push_back(all.back());
  }
  found.error = rms_interval(all, context.run.seed);
  found.edge = rms_interval(edge, context.run.seed);
  found.smooth = rms_interval(smooth, context.run.seed);
  return found;
}

std::vector<double> errors_at_sites(const Truth& truth, const Volume& volume, const SampleSet& samples) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3 world = volume.lattice().frame.world(Vec3(samples.sites.positions[i]));
    errors.push_back(double(samples.radiance[i * std::size_t(samples.channels)]) - truth.e(world).value());
  }
  return errors;
}

}  // namespace isolux::bench
