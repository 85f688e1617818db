#include "files.h"
#include "format_checks.h"
#include "header_bytes.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <array>
#include <cmath>
#include <optional>

namespace isolux::detail {
namespace {

constexpr std::size_t kHeader1 = 348;
constexpr std::size_t kHeader2 = 540;

bool is_gzip(const std::string& path) { return first_bytes(path, 2) == "\x1F\x8B"; }

// The first bytes of what the file holds, inflated if need be.
std::string header_bytes(const std::string& path) {
  if (!is_gzip(path)) return first_bytes(path, kHeader2);
  std::string bytes(kHeader2, '\0');
  bytes.resize(gzip_source(path, 0)->read(std::as_writable_bytes(std::span(bytes))));
  return bytes;
}

struct Version {
  bool second = false;
  bool big_endian = false;
};

// By the header's own size at its start and the magic word.
std::optional<Version> version(const std::string& bytes) {
  for (const bool big_endian : {false, true}) {
    if (bytes.size() < kHeader1) return std::nullopt;
    const HeaderBytes header(bytes, big_endian);
    const auto size = header.get<std::int32_t>(0);
    if (size == int(kHeader1) && bytes.compare(344, 4, std::string("n+1\0", 4)) == 0) return Version{false, big_endian};
    if (size == int(kHeader2) && bytes.size() >= kHeader2 && bytes.compare(4, 4, std::string("n+2\0", 4)) == 0)
      return Version{true, big_endian};
  }
  return std::nullopt;
}

// Bytes a voxel of the scalar types.
std::size_t voxel_bytes(const std::string& path, int datatype) {
  switch (datatype) {
    case 2:
    case 256:
      return 1;
    case 4:
    case 512:
      return 2;
    case 8:
    case 16:
    case 768:
      return 4;
    case 64:
    case 1024:
    case 1280:
      return 8;
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
  std::array<double, 6> qform{};
  int qform_code = 0;
  int sform_code = 0;
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
  return f;
}

void check_geometry(const std::string& path, const Fields& f) {
  require_spacing(path, std::span(f.pixdim).subspan(1));
  require_finite(path, "the intensity scaling", f.scale);
  if (f.qform_code > 0) require_finite(path, "the qform", f.qform);
  if (f.sform_code > 0) require_finite(path, "the sform", f.sform);
}

}  // namespace

bool is_nifti(const std::string& path) {
  try {
    return version(header_bytes(path)).has_value();
  } catch (const Error&) {
    return false;
  }
}

std::string_view nifti_extension(const std::string& path) { return is_gzip(path) ? ".nii.gz" : ".nii"; }

CheckedHeader check_nifti(const std::string& path) {
  const std::uint64_t file_size = require_file(path);
  const std::string bytes = header_bytes(path);
  const auto found = version(bytes);
  if (!found)
    throw InvalidInput(
        fmt::format("{}: no NIfTI file: supported are single files of version 1 ('n+1') and 2 ('n+2')", path));
  const Fields f = fields(HeaderBytes(bytes, found->big_endian), found->second);
  if (f.dim[0] < 1 || f.dim[0] > 7)
    throw InvalidInput(fmt::format("{}: NIfTI dim[0] is {}: allowed is 1 to 7", path, f.dim[0]));
  std::array<std::int64_t, 3> sizes{1, 1, 1};
  for (std::int64_t i = 1; i <= f.dim[0]; ++i) {
    const std::int64_t size = f.dim.at(std::size_t(i));
    if (i <= 3) sizes.at(std::size_t(i) - 1) = size;
    if (i > 3 && size > 1)
      throw InvalidInput(
          fmt::format("{}: {} samples on axis {}: a volume has 3 axes, one number a voxel", path, size, i));
  }
  const std::size_t width = voxel_bytes(path, f.datatype);
  if (f.bits != int(8 * width))
    throw InvalidInput(fmt::format("{}: NIfTI bitpix is {}, datatype {} has {}", path, f.bits, f.datatype, 8 * width));
  check_geometry(path, f);
  const double first = found->second ? 544.0 : 352.0;
  if (!(f.offset >= first && f.offset < 0x1p53 && std::floor(f.offset) == f.offset))
    throw InvalidInput(
        fmt::format("{}: NIfTI vox_offset is {}: a whole number of at least {} is needed", path, f.offset, first));
  const std::uint64_t data = checked_count(path, sizes, width) * width;
  const std::uint64_t needed = std::uint64_t(f.offset) + data;
  if (is_gzip(path)) {
    if (needed / kLargestInflation > file_size)
      throw IoError(
          fmt::format("{}: {} bytes expected, more than {} compressed bytes can hold", path, needed, file_size));
    const std::uint64_t inflated = inflated_bytes(path, 0, needed + 1);
    if (inflated < needed) throw IoError(fmt::format("{}: {} bytes expected, {} found", path, needed, inflated));
  } else if (file_size < needed) {
    throw IoError(fmt::format("{}: {} bytes expected, {} found", path, needed, file_size));
  }
  return {.size = {int(sizes[0]), int(sizes[1]), int(sizes[2])}};
}

}  // namespace isolux::detail
