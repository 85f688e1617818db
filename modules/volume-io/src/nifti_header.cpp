#include "nifti_header.h"

#include "files.h"
#include "format_checks.h"
#include "header_bytes.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <span>
#include <vector>

namespace isolux::detail {
namespace {

constexpr std::size_t kHeader1 = 348;
constexpr std::size_t kHeader2 = 540;
// An sform from a registration stretches a little; one whose axes are this much longer or shorter than pixdim is
// spoiled.
constexpr double kMostStretch = 10.0;

struct Version {
  bool second = false;
  bool big_endian = false;
  bool pair = false;  ///< the values are in another file
};

// By the header's own size at its start and the magic word.
std::optional<Version> version(const std::string& bytes) {
  for (const bool big_endian : {false, true}) {
    if (bytes.size() < kHeader1) return std::nullopt;
    const HeaderBytes header(bytes, big_endian);
    const auto size = header.get<std::int32_t>(0);
    const bool second = size == int(kHeader2) && bytes.size() >= kHeader2;
    if (size != int(kHeader1) && !second) continue;
    const std::string magic = bytes.substr(second ? 4 : 344, 4);
    const char digit = second ? '2' : '1';
    if (magic == std::string{'n', '+', digit, '\0'}) return Version{second, big_endian, false};
    if (magic == std::string{'n', 'i', digit, '\0'}) return Version{second, big_endian, true};
  }
  return std::nullopt;
}

ScalarType scalar_type(const std::string& path, int datatype) {
  switch (datatype) {
    case 2:
      return ScalarType::kUint8;
    case 4:
      return ScalarType::kInt16;
    case 8:
      return ScalarType::kInt32;
    case 16:
      return ScalarType::kFloat32;
    case 64:
      return ScalarType::kFloat64;
    case 256:
      return ScalarType::kInt8;
    case 512:
      return ScalarType::kUint16;
    case 768:
      return ScalarType::kUint32;
    case 1024:
      return ScalarType::kInt64;
    case 1280:
      return ScalarType::kUint64;
    default:
      throw InvalidInput(fmt::format(
          "{}: NIfTI datatype {}: supported are 2, 4, 8, 16, 64, 256, 512, 768, 1024 and 1280, one number a voxel",
          path, datatype));
  }
}

// The fields that matter, of either version.
struct Fields {
  std::array<std::int64_t, 8> dim{};
  int datatype = 0;
  int bits = 0;
  double offset = 0.0;
  std::array<double, 4> pixdim{};  ///< the first is qfac
  std::array<double, 2> scale{};
  std::array<double, 12> sform{};
  std::array<double, 6> qform{};  ///< quaternion b, c, d; offset
  int qform_code = 0;
  int sform_code = 0;
  int units = 0;
};

Fields fields(const HeaderBytes& h, bool second) {
  Fields f;
  for (std::size_t i = 0; i < 8; ++i)
    f.dim[i] = second ? h.get<std::int64_t>(16 + 8 * i) : std::int64_t(h.get<std::int16_t>(40 + 2 * i));
  f.datatype = h.get<std::int16_t>(second ? 12 : 70);
  f.bits = h.get<std::int16_t>(second ? 14 : 72);
  f.offset = second ? double(h.get<std::int64_t>(168)) : double(h.get<float>(108));
  const auto real = [&](std::size_t at1, std::size_t at2, std::size_t i) {
    return second ? h.get<double>(at2 + 8 * i) : double(h.get<float>(at1 + 4 * i));
  };
  for (std::size_t i = 0; i < 4; ++i) f.pixdim[i] = real(76, 104, i);
  for (std::size_t i = 0; i < 2; ++i) f.scale[i] = real(112, 176, i);
  for (std::size_t i = 0; i < 6; ++i) f.qform[i] = real(256, 352, i);
  for (std::size_t i = 0; i < 12; ++i) f.sform[i] = real(280, 400, i);
  f.qform_code = second ? h.get<std::int32_t>(344) : h.get<std::int16_t>(252);
  f.sform_code = second ? h.get<std::int32_t>(348) : h.get<std::int16_t>(254);
  f.units = second ? h.get<std::int32_t>(500) : h.get<std::uint8_t>(123);
  return f;
}

IndexToWorld sform_frame(const Fields& f) {
  IndexToWorld frame;
  for (std::size_t a = 0; a < 3; ++a) frame.axes[int(a)] = Vec3(f.sform.at(a), f.sform.at(4 + a), f.sform.at(8 + a));
  frame.origin = Vec3(f.sform[3], f.sform[7], f.sform[11]);
  return frame;
}

void require_sform(const std::string& path, const Fields& f) {
  require_finite(path, "the sform", f.sform);
  const IndexToWorld frame = sform_frame(f);
  for (int a = 0; a < 3; ++a) {
    const double pixdim = f.pixdim[std::size_t(a) + 1];
    const double stretch = glm::length(frame.axes[a]) / std::fabs(pixdim);
    if (!(stretch > 1.0 / kMostStretch && stretch < kMostStretch))
      throw InvalidInput(
          fmt::format("{}: the sform's axis {} is {:.4g} long, pixdim says {:.4g}: they may differ by a "
                      "factor of {} at most",
                      path, a, glm::length(frame.axes[a]), pixdim, kMostStretch));
  }
}

void require_qform(const std::string& path, const Fields& f) {
  require_finite(path, "the qform", f.qform);
  const Vec3 v(f.qform[0], f.qform[1], f.qform[2]);
  // Half a turn leaves no a; rounding may leave a little less than none.
  if (glm::dot(v, v) > 1.0 + 1e-3)
    throw InvalidInput(
        fmt::format("{}: the qform's quaternion {} {} {}: the sum of squares may be 1 at most", path, v.x, v.y, v.z));
}

// The rotation by the unit quaternion a + ib + jc + kd, of which a >= 0 is left out (nifti1.h, method 2).
IndexToWorld qform_frame(const Fields& f) {
  Vec3 v(f.qform[0], f.qform[1], f.qform[2]);
  const double squares = glm::dot(v, v);
  if (squares > 1.0) v /= std::sqrt(squares);
  const double a = std::sqrt(std::max(0.0, 1.0 - squares));
  const double aa = a * a;
  const double b = v.x;
  const double c = v.y;
  const double d = v.z;
  IndexToWorld frame;
  frame.axes[0] = Vec3(aa + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c));
  frame.axes[1] = Vec3(2 * (b * c - a * d), aa + c * c - b * b - d * d, 2 * (c * d + a * b));
  frame.axes[2] = Vec3(2 * (b * d + a * c), 2 * (c * d - a * b), aa + d * d - c * c - b * b);
  for (int i = 0; i < 3; ++i) frame.axes[i] *= std::fabs(f.pixdim[std::size_t(i) + 1]);
  if (f.pixdim[0] < 0.0) frame.axes[2] = -frame.axes[2];
  frame.origin = Vec3(f.qform[3], f.qform[4], f.qform[5]);
  return frame;
}

double millimetres(const std::string& path, int units) {
  switch (units & 7) {
    case 0:  // unknown
    case 2:
      return 1.0;
    case 1:
      return 1e3;
    case 3:
      return 1e-3;
    default:
      throw InvalidInput(
          fmt::format("{}: NIfTI xyzt_units {}: allowed lengths are 0 (unknown), 1 (metre), 2 "
                      "(millimetre) and 3 (micrometre)",
                      path, units));
  }
}

// Along an axis of one sample nothing is spaced, and many writers leave it at 0.
void fill_spacing(const std::array<std::int64_t, 3>& sizes, Fields& f) {
  for (std::size_t a = 0; a < 3; ++a)
    if (double& spacing = f.pixdim.at(a + 1); sizes.at(a) == 1 && spacing == 0.0) spacing = 1.0;
}

bool by_sform(const Fields& f) { return f.sform_code == 1 || (f.sform_code > 0 && f.qform_code <= 0); }

// What both forms say if they are both there and contradict each other.
std::string contradiction(const std::string& path, const Fields& f, const std::array<std::int64_t, 3>& sizes) {
  constexpr double kMostApart = 1e-2;  // of a voxel: far above the rounding of floats
  if (f.sform_code <= 0 || f.qform_code <= 0) return {};
  const IndexToWorld sform = sform_frame(f);
  const IndexToWorld qform = qform_frame(f);
  const double voxel = std::min({std::fabs(f.pixdim[1]), std::fabs(f.pixdim[2]), std::fabs(f.pixdim[3])});
  double apart = 0.0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3 index(0);
    for (unsigned a = 0; a < 3; ++a)
      if ((corner >> a & 1u) != 0) index[int(a)] = double(sizes.at(a) - 1);
    const double distance = glm::distance(sform.world(index), qform.world(index)) / voxel;
    apart = std::max(apart, std::isfinite(distance) ? distance : HUGE_VAL);
  }
  if (apart <= kMostApart) return {};
  // What is used is checked, so that the other is to blame.
  if (!std::isfinite(apart))
    return by_sform(f) ? fmt::format("{}: its qform (code {}) gives corners no finite places: the sform is used", path,
                                     f.qform_code)
                       : fmt::format("{}: its sform (code {}) gives corners no finite places: the qform is used", path,
                                     f.sform_code);
  return fmt::format(
      "{}: its sform (code {}) and its qform (code {}) place a corner {:.3g} voxels apart: the {} is used, as ITK and "
      "3D Slicer do",
      path, f.sform_code, f.qform_code, apart, by_sform(f) ? "sform" : "qform");
}

IndexToWorld frame_of(const std::string& path, const Fields& f) {
  require_spacing(path, std::span(f.pixdim).subspan(1));
  IndexToWorld frame;
  if (by_sform(f)) {
    require_sform(path, f);
    frame = sform_frame(f);
  } else if (f.qform_code > 0) {
    require_qform(path, f);
    frame = qform_frame(f);
  } else {
    for (int a = 0; a < 3; ++a) frame.axes[a][a] = std::fabs(f.pixdim[std::size_t(a) + 1]);
  }
  const bool anatomical = f.sform_code > 0 || f.qform_code > 0;
  // RAS to LPS; adding 0 leaves no -0, which would be shown and hashed as another number.
  const Vec3 turned = (anatomical ? Vec3(-1, -1, 1) : Vec3(1)) * millimetres(path, f.units);
  for (int a = 0; a < 3; ++a) frame.axes[a] = frame.axes[a] * turned + Vec3(0);
  frame.origin = frame.origin * turned + Vec3(0);
  return frame;
}

/// Of all axes; the first three are of space.
std::vector<std::int64_t> sizes_of(const std::string& path, const Fields& f) {
  if (f.dim[0] < 1 || f.dim[0] > 7)
    throw InvalidInput(fmt::format("{}: NIfTI dim[0] is {}: allowed is 1 to 7", path, f.dim[0]));
  std::vector<std::int64_t> sizes(f.dim.begin() + 1, f.dim.begin() + 1 + f.dim[0]);
  sizes.resize(std::max<std::size_t>(sizes.size(), 3), 1);
  return sizes;
}

std::uint64_t data_offset(const std::string& path, const Fields& f, bool second) {
  const double first = second ? 544.0 : 352.0;
  if (!(f.offset >= first && f.offset < 0x1p53 && std::floor(f.offset) == f.offset))
    throw InvalidInput(
        fmt::format("{}: NIfTI vox_offset is {}: a whole number of at least {} is needed", path, f.offset, first));
  return std::uint64_t(f.offset);
}

}  // namespace

bool is_nifti(const std::string& path) {
  try {
    return version(first_inflated(path, kHeader2)).has_value();
  } catch (const Error&) {
    return false;
  }
}

NiftiHeader read_nifti_header(const std::string& path, int frame) {
  (void)require_file(path);
  const std::string bytes = first_inflated(path, kHeader2);
  const auto found = version(bytes);
  if (!found)
    throw InvalidInput(
        fmt::format("{}: no NIfTI file: supported are single files of version 1 ('n+1') and 2 ('n+2')", path));
  if (found->pair)
    throw InvalidInput(fmt::format("{}: the header of a NIfTI pair (.hdr and .img): supported are single files", path));
  Fields f = fields(HeaderBytes(bytes, found->big_endian), found->second);
  const auto all_sizes = sizes_of(path, f);
  const std::array<std::int64_t, 3> sizes = {all_sizes[0], all_sizes[1], all_sizes[2]};
  fill_spacing(sizes, f);
  const ScalarType type = scalar_type(path, f.datatype);
  const std::size_t width = bytes_per_scalar(type);
  if (f.bits != int(8 * width))
    throw InvalidInput(fmt::format("{}: NIfTI bitpix is {}, datatype {} has {}", path, f.bits, f.datatype, 8 * width));
  NiftiHeader header;
  header.lattice.frame = frame_of(path, f);
  header.remark = contradiction(path, f, sizes);
  header.data = {.file = path, .compressed = is_gzip(path), .more_allowed = true, .layout = {type, found->big_endian}};
  (header.data.compressed ? header.data.skipped : header.data.offset) = data_offset(path, f, found->second);
  // A slope of 0 or of no number says that there is no scaling, whatever the intercept.
  if (f.scale[0] != 0.0 && std::isfinite(f.scale[0])) {
    require_finite(path, "the intensity scaling", f.scale);
    header.data.slope = f.scale[0];
    header.data.intercept = f.scale[1];
  }
  const std::uint64_t count = checked_count(path, sizes, width);
  const std::uint64_t volumes = checked_count(path, all_sizes, width) / count;
  const auto what = fmt::format("{} volumes along the axes behind the third", volumes);
  header.data.frames = {volumes, count, wanted_frame(path, "nifti", frame, volumes, what)};
  require_room(header.data, count);
  header.lattice.size = {int(sizes[0]), int(sizes[1]), int(sizes[2])};
  return header;
}

}  // namespace isolux::detail
