// The denoiser's wide search and fits against plain ones, at every instruction set.
#include <gtest/gtest.h>
#include <isolux/core/random.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "bin_order.h"
#include "local_fit.h"
#include "wide/denoise_kernels.h"
#include "wide_targets.h"

namespace isolux {
namespace {

using wide::BinnedSamples;
using wide::NearSamples;

constexpr wide::WindowLimits kLimits{
    .counts = {57, 123, 203}, .apart = 5.0f, .unseen = 1e-7f, .ridge = 0.001f, .unit = 2.0f};

/// Half of the samples anywhere in a box, the others in a corner of it and beyond, with light that is linear in place.
struct Cloud {
  explicit Cloud(std::size_t count, std::size_t channels = 1) : random(3, count) {
    std::vector<Point> points;
    for (std::size_t s = 0; s < count; ++s) {
      const float size = s % 2 == 0 ? 1.0f : 0.3f;
      points.push_back(
          {{size * 14.0f * value() - 0.5f, size * 9.0f * value(), size * 11.0f * value(), 2.0f * value()}});
    }
    const BinOrder order(points, {{13.0f, 9.0f, 11.0f, 0.0f}}, 1.0);
    all.bins = order.size;
    all.starts = order.starts;
    all.side = order.side;
    all.channels = channels;
    all.looks.resize(count * all.stride());
    for (std::size_t s = 0; s < count; ++s)
      for (std::size_t a = 0; a < 4; ++a) all.look(s)[a] = points[order.points[s]].x[a] / order.side;
    copy_places();
    for (std::size_t s = 0; s < count; ++s) {
      float* const look = all.look(s);
      const float turn = 0.3f * value();
      look[BinnedSamples::kNormal] = std::sin(turn);
      look[BinnedSamples::kNormal + 2] = std::cos(turn);
      for (std::size_t t = 0; t < 3; ++t) look[BinnedSamples::kOpenness + t] = value();
      look[BinnedSamples::kVariance] = 1e-3f * value();
      for (std::size_t c = 0; c < channels; ++c) light(s)[c] = 0.02f * (all.places[0][s] - float(c) * all.places[2][s]);
    }
  }
  void copy_places() {
    for (std::size_t a = 0; a < 3; ++a) {
      all.places[a].assign(all.size() + BinnedSamples::kPastTheEnd, 0.0f);
      for (std::size_t s = 0; s < all.size(); ++s) all.places[a][s] = all.look(s)[a];
    }
  }
  [[nodiscard]] float value() { return random.uniform_float(); }
  [[nodiscard]] float* light(std::size_t s) { return all.look(s) + BinnedSamples::kLight; }
  void add_noise() {
    for (std::size_t s = 0; s < all.size(); ++s)
      for (std::size_t c = 0; c < all.channels; ++c) light(s)[c] += 0.05f * value();
  }
  [[nodiscard]] float reach(std::size_t a, std::size_t b) const {
    float sum = 0.0f;
    for (const auto& place : all.places) sum += (place[a] - place[b]) * (place[a] - place[b]);
    return sum;
  }

  RandomStream random;
  BinnedSamples all;
};

class DenoiseKernels : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { test::choose_target(GetParam()); }
  void TearDown() override { test::choose_target(0); }

  static std::vector<std::uint32_t> nearest(const Cloud& cloud, std::size_t sample, std::size_t count, float bound) {
    NearSamples near;
    near.bound = bound;
    wide::denoise_kernels(cloud.all.channels).nearest(cloud.all, sample, count, near);
    near.samples.resize(near.count);
    return near.samples;
  }
  static wide::WindowFits fits(const Cloud& cloud, std::size_t sample) {
    const wide::DenoiseKernels kernels = wide::denoise_kernels(cloud.all.channels);
    NearSamples near;
    kernels.nearest(cloud.all, sample, kLimits.counts.back(), near);
    wide::WindowFits fits;
    EXPECT_TRUE(kernels.fit(cloud.all, sample, near, kLimits, fits));
    return fits;
  }
};

TEST_P(DenoiseKernels, FindTheNearest) {
  const Cloud cloud(3000);
  for (std::size_t sample = 0; sample < 3000; sample += 97) {
    for (const std::size_t count : {1u, 20u, 200u, 2999u}) {
      const std::vector<std::uint32_t> found = nearest(cloud, sample, count, 16.0f);
      ASSERT_EQ(found.size(), count);
      std::vector<bool> chosen(3000, false);
      float farthest = 0.0f;
      for (const std::uint32_t other : found) {
        EXPECT_FALSE(chosen[other]);
        chosen[other] = true;
        EXPECT_GE(cloud.reach(sample, other) * 1.07f + 0.27f, farthest) << "within a class of distances";
        farthest = std::max(farthest, cloud.reach(sample, other));
      }
      for (std::size_t other = 0; other < 3000; ++other) {
        if (chosen[other]) continue;
        EXPECT_GE(cloud.reach(sample, other) * 1.07f + 0.27f, farthest) << sample << " " << count;
      }
    }
  }
}

TEST_P(DenoiseKernels, FindTheSameWhereverTheSearchBegins) {
  const Cloud cloud(1500);
  for (std::size_t sample = 0; sample < 1500; sample += 131) {
    const std::vector<std::uint32_t> found = nearest(cloud, sample, 57, 16.0f);
    for (const float bound : {1e-3f, 1.0f, 30.0f, 1e6f}) EXPECT_EQ(nearest(cloud, sample, 57, bound), found) << bound;
  }
}

/// One sample in the middle of each bin of a box but for a hole.
BinnedSamples lattice() {
  std::vector<Point> points;
  for (int k = 0; k < 11; ++k)
    for (int j = 0; j < 13; ++j)
      for (int i = 0; i < 14; ++i)
        if (i != 7 || j != 10 || k != 5) points.push_back({{float(i) + 0.4f, float(j) + 0.5f, float(k) + 0.3f, 0.0f}});
  const BinOrder order(points, {{14.0f, 13.0f, 11.0f, 0.0f}}, 2001.0 / 2002.0);
  BinnedSamples all;
  all.bins = order.size;
  all.starts = order.starts;
  all.looks.resize(points.size() * all.stride());
  for (std::size_t a = 0; a < 3; ++a) {
    all.places[a].assign(points.size() + BinnedSamples::kPastTheEnd, 0.0f);
    for (std::size_t s = 0; s < points.size(); ++s) all.places[a][s] = points[order.points[s]].x[a];
  }
  return all;
}

TEST_P(DenoiseKernels, FindTheSameByStencil) {
  BinnedSamples plain = lattice();
  ASSERT_EQ(plain.bins, (std::array<int, 3>{14, 13, 11}));
  BinnedSamples by_stencil = plain;
  by_stencil.stencil = wide::Stencil::of(plain.bins, 200);
  const auto nearest = wide::denoise_kernels(1).nearest;
  std::size_t searched = 0;
  for (std::size_t s = 0; s < plain.size(); ++s) {
    NearSamples found;
    NearSamples taken;
    nearest(plain, s, 57, found);
    nearest(by_stencil, s, 57, taken);
    searched += taken.candidates.empty() ? 0 : 1;
    ASSERT_EQ(taken.count, 57u);
    // Classes of distances end at whole squares, where rounding decides: whole shells are compared.
    std::sort(found.samples.begin(), found.samples.begin() + 57);
    std::sort(taken.samples.begin(), taken.samples.begin() + 57);
    for (std::size_t n = 0; n < 57; ++n) ASSERT_EQ(found.samples[n], taken.samples[n]) << s;
  }
  // The stencil reaches two bins along each axis. The hole is two rows from the box's end, so that it is missed by the
  // 38 of the 56 around it that are no nearer to that.
  EXPECT_EQ(searched, 2001u - (10u * 9u * 7u - 1u - 38u));
}

TEST_P(DenoiseKernels, FindAllWhereThereAreFewer) {
  const Cloud cloud(40);
  std::vector<std::uint32_t> found = nearest(cloud, 7, 200, 16.0f);
  std::sort(found.begin(), found.end());
  ASSERT_EQ(found.size(), 40u);
  for (std::uint32_t s = 0; s < 40; ++s) EXPECT_EQ(found[s], s);
}

TEST_P(DenoiseKernels, FitAsALeastSquaresFitInDoublePrecisionDoes) {
  for (const std::size_t channels : {1u, 3u}) {
    Cloud cloud(3000, channels);
    cloud.add_noise();
    for (std::size_t sample = 0; sample < 3000; sample += 211) {
      const wide::WindowFits fitted = fits(cloud, sample);
      const std::vector<std::uint32_t> near = nearest(cloud, sample, 203, 16.0f);
      const auto normal = [&](std::size_t s, std::size_t a) {
        return double(cloud.all.look(s)[BinnedSamples::kNormal + a]);
      };
      const auto likeness = [&](std::size_t s) {
        double cosine = 0.0;
        for (std::size_t a = 0; a < 3; ++a) cosine += normal(sample, a) * normal(s, a);
        return std::max(cosine, 0.0) * std::max(cosine, 0.0) + 1e-6;
      };
      double variance = 0.0;
      double weights = 0.0;
      for (const std::uint32_t s : near) {
        weights += likeness(s);
        variance += likeness(s) * double(cloud.all.look(s)[BinnedSamples::kVariance]);
      }
      const double apart = 25.0 * variance / weights + kNoError;
      std::vector<double> narrowest(203, 0.0);
      for (std::size_t w = 0; w < kWindowCount; ++w) {
        double far = 0.0;
        for (std::size_t n = 0; n < kLimits.counts[w]; ++n)
          far = std::max(far, std::sqrt(double(cloud.reach(sample, near[n]))));
        LocalFit<10> fit;
        std::vector<double> parts;
        std::vector<LocalFit<10>::Coordinates> coordinates;
        for (std::size_t n = 0; n < kLimits.counts[w]; ++n) {
          const std::uint32_t s = near[n];
          LocalFit<10>::Coordinates at{};
          for (std::size_t a = 0; a < 4; ++a)
            at[a] = double(cloud.all.side) * (double(cloud.all.look(s)[a]) - double(cloud.all.look(sample)[a]));
          for (std::size_t a = 0; a < 6; ++a) at[4 + a] = 2.0 * (normal(s, a) - normal(sample, a));
          double squares = 0.0;
          for (std::size_t c = 0; c < channels; ++c)
            squares += std::pow(double(cloud.light(s)[c]) - double(cloud.light(sample)[c]), 2.0) / double(channels);
          const double ratio = squares / apart;
          parts.push_back((1.0 - 0.75 * std::sqrt(double(cloud.reach(sample, s))) / far) * likeness(s) /
                          (1.0 + ratio * ratio * ratio));
          coordinates.push_back(at);
          fit.add(parts.back(), at, cloud.light(s), channels);
        }
        std::array<float, 3> light{};
        const auto influence = fit.at_origin(double(kLimits.ridge), light.data(), channels);
        for (std::size_t c = 0; c < channels; ++c) EXPECT_NEAR(fitted.light[w][c], light[c], 2e-5f);
        double noise = 0.0;
        double noise_apart = 0.0;
        for (std::size_t n = 0; n < parts.size(); ++n) {
          const double part = parts[n] * influence.of(coordinates[n]);
          if (w == 0) narrowest[n] = part;
          noise += part * part;
          noise_apart += (part - narrowest[n]) * (part - narrowest[n]);
        }
        EXPECT_NEAR(double(fitted.noise[w]), noise, 1e-3 * noise);
        EXPECT_NEAR(double(fitted.noise_apart[w]), noise_apart, 1e-3 * noise);
        if (w > 0) continue;
        EXPECT_NEAR(double(fitted.follows), std::min(1.0, influence.there), 1e-3 * influence.there);
      }
    }
  }
}

TEST_P(DenoiseKernels, KeepLightThatIsTheSameEverywhere) {
  for (const std::size_t channels : {1u, 3u}) {
    Cloud cloud(500, channels);
    for (std::size_t s = 0; s < 500; ++s)
      for (std::size_t c = 0; c < channels; ++c) cloud.light(s)[c] = 0.3f * float(c + 1);
    for (std::size_t sample = 0; sample < 500; sample += 61) {
      const wide::WindowFits fitted = fits(cloud, sample);
      for (const auto& light : fitted.light)
        for (std::size_t c = 0; c < channels; ++c) EXPECT_EQ(light[c], 0.3f * float(c + 1));
    }
  }
}

TEST_P(DenoiseKernels, TakeTheMeanWhereAllSamplesAreAtOnePlace) {
  Cloud cloud(60);
  double mean = 0.0;
  for (std::size_t s = 0; s < 60; ++s) {
    std::copy_n(cloud.all.look(0), BinnedSamples::kLight, cloud.all.look(s));
    cloud.light(s)[0] = 0.01f * cloud.value();
    mean += double(cloud.light(s)[0]) / 60.0;
  }
  const wide::DenoiseKernels kernels = wide::denoise_kernels(1);
  NearSamples near;
  for (std::uint32_t s = 0; s < 60; ++s) near.samples.push_back(s);
  near.count = 60;
  wide::WindowLimits limits = kLimits;
  limits.apart = 1e6f;
  wide::WindowFits fitted;
  ASSERT_TRUE(kernels.fit(cloud.all, 5, near, limits, fitted));
  EXPECT_NEAR(double(fitted.light[1][0]), mean, 1e-6);
  EXPECT_NEAR(double(fitted.noise[1]), 1.0 / 60.0, 1e-5);
}

TEST_P(DenoiseKernels, LeaveAloneWhatHasNoNoise) {
  Cloud cloud(300);
  for (std::size_t s = 0; s < 300; ++s) cloud.all.look(s)[BinnedSamples::kVariance] = kLimits.unseen;
  const wide::DenoiseKernels kernels = wide::denoise_kernels(1);
  NearSamples near;
  kernels.nearest(cloud.all, 9, 203, near);
  wide::WindowFits fitted;
  EXPECT_FALSE(kernels.fit(cloud.all, 9, near, kLimits, fitted));
  cloud.all.look(near.samples[202])[BinnedSamples::kVariance] = 2.0f * kLimits.unseen;
  EXPECT_TRUE(kernels.fit(cloud.all, 9, near, kLimits, fitted));
}

INSTANTIATE_TEST_SUITE_P(EveryTarget, DenoiseKernels, ::testing::ValuesIn(test::wide_targets()),
                         test::wide_target_name);

}  // namespace
}  // namespace isolux
