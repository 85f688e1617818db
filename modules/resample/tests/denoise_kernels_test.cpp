// The denoiser's wide fits against plain ones, at every instruction set.
#include "wide/denoise_kernels.h"

#include <gtest/gtest.h>
#include <isolux/core/random.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "local_fit.h"
#include "wide_targets.h"

namespace isolux {
namespace {

using wide::LatticeSamples;
using wide::WindowFits;

constexpr wide::WindowLimits kLimits{
    .counts = {57, 123, 203}, .apart = 5.0f, .unseen = 1e-7f, .ridge = 0.001f, .unit = 2.0f};

/// A box of points, of which some hold a sample, with light that is linear in place.
struct Box {
  explicit Box(double part, std::size_t channels = 1, std::array<double, 3> apart = {1.0, 1.0, 1.0})
      : steps(apart), random(3, channels) {
    all.size = {21, 9, 8};
    all.channels = channels;
    all.looks = SampleWindow<float>(LatticeSamples::stride(channels));
    all.stencil = wide::Stencil::of(apart, all.size);
    for (int k = 0; k < all.size[2]; ++k)
      for (int j = 0; j < all.size[1]; ++j)
        for (int i = 0; i < all.size[0]; ++i) put(i, j, k, part);
  }
  void put(int i, int j, int k, double part) {
    all.at.push_back(LatticeSamples::kNone);
    if (random.uniform_double() >= part) return;
    all.at.back() = std::uint32_t(points.size());
    points.push_back({i, j, k});
    all.looks.hold_until(points.size());
    float* const look = all.look(points.size() - 1);
    const float turn = 0.3f * value();
    look[LatticeSamples::kIsovalue] = value();
    look[LatticeSamples::kNormal] = std::sin(turn);
    look[LatticeSamples::kNormal + 2] = std::cos(turn);
    for (std::size_t t = 0; t < 3; ++t) look[LatticeSamples::kOpenness + t] = value();
    look[LatticeSamples::kVariance] = 1e-3f * value();
    for (std::size_t c = 0; c < all.channels; ++c)
      light(points.size() - 1)[c] = 0.02f * (float(i) - float(c) * float(k));
  }
  [[nodiscard]] float value() { return random.uniform_float(); }
  [[nodiscard]] float* light(std::size_t s) { return all.look(s) + LatticeSamples::kLight; }
  void add_noise() {
    for (std::size_t s = 0; s < points.size(); ++s)
      for (std::size_t c = 0; c < all.channels; ++c) light(s)[c] += 0.05f * value();
  }
  [[nodiscard]] double place(std::size_t s, std::size_t from, std::size_t a) const {
    return steps[a] * (points[s][a] - points[from][a]);
  }

  std::array<double, 3> steps;
  RandomStream random;
  LatticeSamples all;
  std::vector<std::array<int, 3>> points;  ///< of the samples
};

class DenoiseKernels : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { test::choose_target(GetParam()); }
  void TearDown() override { test::choose_target(0); }

  /// By sample, in rows that begin so many points along x.
  static std::vector<WindowFits> fits(const Box& box, std::size_t first = 0) {
    const wide::DenoiseKernels kernels = wide::denoise_kernels(box.all.channels);
    std::vector<WindowFits> result(box.points.size());
    std::array<WindowFits, wide::DenoiseKernels::kMostLanes> row;
    for (int k = 0; k < box.all.size[2]; ++k) {
      for (int j = 0; j < box.all.size[1]; ++j) {
        for (auto x = first; x < std::size_t(box.all.size[0]); x += kernels.lanes) {
          const auto count = std::min(kernels.lanes, std::size_t(box.all.size[0]) - x);
          kernels.fit_row(box.all, {int(x), j, k}, kLimits, std::span(row).first(count));
          for (std::size_t n = 0; n < count; ++n) {
            const std::uint32_t s = box.all.at[box.all.row(j, k) + x + n];
            if (s != LatticeSamples::kNone) result[s] = row[n];
          }
        }
      }
    }
    return result;
  }
};

/// The windows of a sample: the samples of whole shells, nearest first, and how many of these each has.
struct Windows {
  std::vector<std::size_t> samples;
  std::vector<double> distances;  ///< of their shells
  std::array<std::size_t, kWindowCount> counts{};

  Windows(const Box& box, std::size_t s) {
    std::size_t m = 0;
    for (const wide::Stencil::Shell& shell : box.all.stencil.shells) {
      const std::size_t before = samples.size();
      for (; m < shell.end; ++m) {
        std::array<int, 3> at = box.points[s];
        bool inside = true;
        for (std::size_t a = 0; a < 3; ++a) {
          at[a] += box.all.stencil.members[m].step[a];
          inside = inside && at[a] >= 0 && at[a] < box.all.size[a];
        }
        const std::uint32_t other =
            inside ? box.all.at[box.all.row(at[1], at[2]) + std::size_t(at[0])] : LatticeSamples::kNone;
        if (other == LatticeSamples::kNone || before >= kLimits.counts.back()) continue;
        samples.push_back(other);
        distances.push_back(double(shell.distance));
      }
      for (std::size_t w = 0; w < kWindowCount; ++w)
        if (before < kLimits.counts[w]) counts[w] = samples.size();
    }
  }
};

void expect_fits_in_doubles(Box& box, std::size_t sample, const WindowFits& fitted) {
  const Windows windows(box, sample);
  const auto look = [&](std::size_t s, std::size_t a) { return double(box.all.look(s)[a]); };
  const auto likeness = [&](std::size_t s) {
    double cosine = 0.0;
    for (std::size_t a = LatticeSamples::kNormal; a < LatticeSamples::kOpenness; ++a)
      cosine += look(sample, a) * look(s, a);
    return std::max(cosine, 0.0) * std::max(cosine, 0.0) + 1e-6;
  };
  double variance = 0.0;
  double weights = 0.0;
  for (const std::size_t s : windows.samples) {
    weights += likeness(s);
    variance += likeness(s) * look(s, LatticeSamples::kVariance);
  }
  const double apart = 25.0 * variance / weights + kNoError;
  std::vector<double> narrowest(windows.samples.size(), 0.0);
  for (std::size_t w = 0; w < kWindowCount; ++w) {
    const double far = windows.distances[windows.counts[w] - 1];
    LocalFit<10> fit;
    std::vector<double> parts;
    std::vector<LocalFit<10>::Coordinates> coordinates;
    for (std::size_t n = 0; n < windows.counts[w]; ++n) {
      const std::size_t s = windows.samples[n];
      LocalFit<10>::Coordinates at{};
      for (std::size_t a = 0; a < 3; ++a) at[a] = box.place(s, sample, a);
      at[3] = look(s, LatticeSamples::kIsovalue) - look(sample, LatticeSamples::kIsovalue);
      for (std::size_t a = 0; a < 6; ++a)
        at[4 + a] = 2.0 * (look(s, LatticeSamples::kNormal + a) - look(sample, LatticeSamples::kNormal + a));
      double squares = 0.0;
      for (std::size_t c = 0; c < box.all.channels; ++c)
        squares += std::pow(double(box.light(s)[c]) - double(box.light(sample)[c]), 2.0) / double(box.all.channels);
      const double ratio = squares / apart;
      parts.push_back((1.0 - 0.75 * windows.distances[n] / far) * likeness(s) / (1.0 + ratio * ratio * ratio));
      coordinates.push_back(at);
      fit.add(parts.back(), at, box.light(s), box.all.channels);
    }
    std::array<float, 3> light{};
    const auto influence = fit.at_origin(double(kLimits.ridge), light.data(), box.all.channels);
    for (std::size_t c = 0; c < box.all.channels; ++c) EXPECT_NEAR(fitted.light[w][c], light[c], 2e-5f) << sample;
    double noise = 0.0;
    double noise_apart = 0.0;
    for (std::size_t n = 0; n < parts.size(); ++n) {
      const double part = parts[n] * influence.of(coordinates[n]);
      if (w == 0) narrowest[n] = part;
      noise += part * part;
      noise_apart += (part - narrowest[n]) * (part - narrowest[n]);
    }
    EXPECT_NEAR(double(fitted.noise[w]), noise, 1e-3 * noise) << sample << " " << w;
    EXPECT_NEAR(double(fitted.noise_apart[w]), noise_apart, 1e-3 * noise) << sample << " " << w;
    if (w > 0) continue;
    EXPECT_NEAR(double(fitted.follows), std::min(1.0, influence.there), 1e-3 * influence.there);
  }
}

TEST_P(DenoiseKernels, FitAsALeastSquaresFitInDoublePrecisionDoes) {
  for (const std::size_t channels : {1u, 3u}) {
    for (const double part : {0.3, 0.75, 1.0}) {
      for (const std::array<double, 3>& steps : {std::array{1.0, 1.0, 1.0}, std::array{1.3, 0.7, 2.2}}) {
        Box box(part, channels, steps);
        box.add_noise();
        const std::vector<WindowFits> fitted = fits(box);
        for (std::size_t s = 0; s < fitted.size(); s += 41) {
          ASSERT_TRUE(fitted[s].is_fitted);
          expect_fits_in_doubles(box, s, fitted[s]);
        }
      }
    }
  }
}

TEST_P(DenoiseKernels, FitTheSameWhereverARowBegins) {
  Box box(0.7);
  box.add_noise();
  const std::vector<WindowFits> whole = fits(box);
  const std::vector<WindowFits> later = fits(box, 5);
  for (std::size_t s = 0; s < whole.size(); ++s) {
    if (box.points[s][0] < 5) continue;
    EXPECT_EQ(whole[s].light, later[s].light);
    EXPECT_EQ(whole[s].noise, later[s].noise);
    EXPECT_EQ(whole[s].noise_apart, later[s].noise_apart);
  }
}

TEST_P(DenoiseKernels, KeepLightThatIsTheSameEverywhere) {
  for (const std::size_t channels : {1u, 3u}) {
    Box box(0.6, channels);
    for (std::size_t s = 0; s < box.points.size(); ++s)
      for (std::size_t c = 0; c < channels; ++c) box.light(s)[c] = 0.3f * float(c + 1);
    for (const WindowFits& fitted : fits(box))
      for (const auto& light : fitted.light)
        for (std::size_t c = 0; c < channels; ++c) EXPECT_EQ(light[c], 0.3f * float(c + 1));
  }
}

TEST_P(DenoiseKernels, KeepASampleThatIsAlone) {
  Box box(0.0);
  box.all.at[box.all.row(4, 3) + 10] = 0;
  box.points.push_back({10, 4, 3});
  box.all.looks.hold_until(1);
  std::fill_n(box.all.look(0), LatticeSamples::stride(1), 0.5f);
  const WindowFits fitted = fits(box)[0];
  ASSERT_TRUE(fitted.is_fitted);
  for (std::size_t w = 0; w < kWindowCount; ++w) {
    EXPECT_EQ(fitted.light[w][0], 0.5f);
    EXPECT_NEAR(fitted.noise[w], 1.0f, 1e-6f);
    EXPECT_NEAR(fitted.noise_apart[w], 0.0f, 1e-6f);
  }
}

TEST_P(DenoiseKernels, LeaveAloneWhatHasNoNoise) {
  Box box(1.0);
  for (std::size_t s = 0; s < box.points.size(); ++s) box.all.look(s)[LatticeSamples::kVariance] = kLimits.unseen;
  for (const WindowFits& fitted : fits(box)) EXPECT_FALSE(fitted.is_fitted);
  const std::size_t noisy = box.all.at[box.all.row(4, 4) + 10];
  box.all.look(noisy)[LatticeSamples::kVariance] = 2.0f * kLimits.unseen;
  const std::vector<WindowFits> fitted = fits(box);
  for (std::size_t s = 0; s < box.points.size(); ++s) {
    const Windows windows(box, s);
    const bool sees = std::find(windows.samples.begin(), windows.samples.end(), noisy) != windows.samples.end();
    EXPECT_EQ(fitted[s].is_fitted, sees) << s;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryTarget, DenoiseKernels, ::testing::ValuesIn(test::wide_targets()),
                         test::wide_target_name);

}  // namespace
}  // namespace isolux
