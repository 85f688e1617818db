#include "environment.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace isolux {
namespace {

constexpr double kPi = std::numbers::pi;

bool is_black(const Vec3f& c) { return c == Vec3f(0.0f); }

// World x, made perpendicular to up, is what the middle of an image shows; world y where up is x.
Frame image_frame(const Vec3f& up) {
  const Vec3 z = glm::normalize(Vec3(up));
  const Vec3 ahead = std::fabs(z.x) < 0.999 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
  const Vec3 x = glm::normalize(ahead - z * glm::dot(ahead, z));
  return {.x = x, .y = glm::cross(z, x), .z = z};
}

const Vec3f& pixel(const ImageEnvironment& image, int column, int row) {
  const int x = (column + image.width) % image.width;
  const int y = std::clamp(row, 0, image.height - 1);
  return image.pixels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
}

// Rows of patches begin at the top edge and at each pixel centre.
double patch_row_edge(int row, int height) { return std::clamp((row - 0.5) / height, 0.0, 1.0); }

// Index of the interval of running sums [0, s0, s1, ...] that holds `wanted`, and the place in it.
std::size_t find_interval(const double* sums, std::size_t count, double wanted, double& fraction) {
  const auto* end = sums + count;
  std::size_t i = std::size_t(std::upper_bound(sums, end, wanted) - sums);
  // The last interval that holds anything, where rounding has led past the end.
  if (i == count) i = std::size_t(std::lower_bound(sums, end, sums[count - 1]) - sums);
  const double low = i > 0 ? sums[i - 1] : 0.0;
  fraction = std::clamp((wanted - low) / (sums[i] - low), 0.0, 1.0);
  return i;
}

}  // namespace

double luminance(const Vec3f& c) { return 0.2126 * double(c.x) + 0.7152 * double(c.y) + 0.0722 * double(c.z); }

EnvironmentView::EnvironmentView(const Environment& environment) : environment_(&environment) {
  if (const auto* sky = std::get_if<SkyEnvironment>(&environment)) frame_ = image_frame(sky->up);
  if (const auto* image = std::get_if<ImageEnvironment>(&environment)) frame_ = image_frame(image->up);
}

PreparedEnvironment::PreparedEnvironment(const Environment& environment) : EnvironmentView(environment) {
  if (std::holds_alternative<ImageEnvironment>(environment) && shines()) prepare_image();
}

bool EnvironmentView::shines() const {
  if (const auto* uniform = std::get_if<UniformEnvironment>(environment_)) return !is_black(uniform->radiance);
  if (const auto* sky = std::get_if<SkyEnvironment>(environment_))
    return !(is_black(sky->zenith) && is_black(sky->horizon) && is_black(sky->ground));
  const auto& pixels = std::get<ImageEnvironment>(*environment_).pixels;
  return !std::all_of(pixels.begin(), pixels.end(), is_black);
}

void PreparedEnvironment::prepare_image() {
  const auto& image = std::get<ImageEnvironment>(*environment_);
  double total = 0.0;
  for (int row = 0; row <= image.height; ++row) {
    const double top = patch_row_edge(row, image.height);
    const double bottom = patch_row_edge(row + 1, image.height);
    const double area = (std::cos(kPi * top) - std::cos(kPi * bottom)) * 2.0 * kPi / image.width;
    double sum = 0.0;
    for (int column = 0; column < image.width; ++column) {
      double mean = 0.0;
      for (int q = 0; q < 4; ++q) mean += 0.25 * luminance(pixel(image, column + (q & 1), row - 1 + (q >> 1)));
      sum += mean * area;
      patch_sums_.push_back(sum);
    }
    total += sum;
    row_sums_.push_back(total);
  }
  if (total > 0.0) return;
  patch_sums_.clear();
  row_sums_.clear();
}

EnvironmentView::Place EnvironmentView::place(const Vec3& towards) const {
  const double x = glm::dot(towards, frame_.x);
  const double y = glm::dot(towards, frame_.y);
  const double z = glm::dot(towards, frame_.z);
  return {.column = 0.5 - std::atan2(y, x) / (2.0 * kPi), .row = std::atan2(std::hypot(x, y), z) / kPi};
}

Vec3 EnvironmentView::image_radiance(const Place& place) const {
  const auto& image = std::get<ImageEnvironment>(*environment_);
  const double x = place.column * image.width - 0.5;
  const double y = place.row * image.height - 0.5;
  const int i = int(std::floor(x));
  const int j = int(std::floor(y));
  const double fx = x - i;
  const double fy = y - j;
  return (1.0 - fy) * ((1.0 - fx) * Vec3(pixel(image, i, j)) + fx * Vec3(pixel(image, i + 1, j))) +
         fy * ((1.0 - fx) * Vec3(pixel(image, i, j + 1)) + fx * Vec3(pixel(image, i + 1, j + 1)));
}

Vec3 EnvironmentView::radiance(const Vec3& towards) const {
  if (const auto* uniform = std::get_if<UniformEnvironment>(environment_)) return Vec3(uniform->radiance);
  if (const auto* sky = std::get_if<SkyEnvironment>(environment_)) {
    const double sine = glm::dot(towards, frame_.z);
    if (sine < 0.0) return Vec3(sky->ground);
    return (1.0 - sine) * Vec3(sky->horizon) + sine * Vec3(sky->zenith);
  }
  return image_radiance(place(towards));
}

PreparedEnvironment::Sample PreparedEnvironment::sample(double u, double v) const {
  const auto& image = std::get<ImageEnvironment>(*environment_);
  const auto width = std::size_t(image.width);
  const double total = row_sums_.back();
  double in_row = 0.0;
  const std::size_t row = find_interval(row_sums_.data(), row_sums_.size(), v * total, in_row);
  const double* patches = patch_sums_.data() + row * width;
  double in_column = 0.0;
  const std::size_t column = find_interval(patches, width, u * patches[width - 1], in_column);
  // Uniform in solid angle within the patch: its height is uniform.
  const double top = std::cos(kPi * patch_row_edge(int(row), image.height));
  const double bottom = std::cos(kPi * patch_row_edge(int(row) + 1, image.height));
  const double z = top + in_row * (bottom - top);
  const double azimuth = 2.0 * kPi * (0.5 - (double(column) + 0.5 + in_column) / image.width);
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  const double patch = patches[column] - (column > 0 ? patches[column - 1] : 0.0);
  const double area = (top - bottom) * 2.0 * kPi / image.width;
  return {.towards = frame_.world({r * std::cos(azimuth), r * std::sin(azimuth), z}),
          .density = patch / (total * area)};
}

double PreparedEnvironment::density(const Vec3& towards) const {
  const auto& image = std::get<ImageEnvironment>(*environment_);
  const Place at = place(towards);
  const int row = std::clamp(int(std::floor(at.row * image.height + 0.5)), 0, image.height);
  const int column = (int(std::floor(at.column * image.width - 0.5)) + image.width) % image.width;
  const double* patches = patch_sums_.data() + std::size_t(row) * std::size_t(image.width);
  const double patch = patches[column] - (column > 0 ? patches[column - 1] : 0.0);
  const double top = std::cos(kPi * patch_row_edge(row, image.height));
  const double bottom = std::cos(kPi * patch_row_edge(row + 1, image.height));
  return patch / (row_sums_.back() * (top - bottom) * 2.0 * kPi / image.width);
}

}  // namespace isolux
