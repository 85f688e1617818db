#include "files.h"
#include "nrrd_write.h"
#include "raw_name.h"
#include "scalars.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/atomic_file.h>
#include <isolux/volume_io/write.h>

#include <filesystem>

namespace isolux {
namespace {

detail::NrrdImage nrrd_image(const VolumeView& volume, const WriteOptions& options) {
  return {.type = volume.stored_type(),
          .channels = 1,
          .lattice = volume.lattice(),
          .space = volume.space(),
          .key_values = {},
          .compress = options.compress,
          .data_file = {}};
}

void write_attached(const VolumeView& volume, const std::string& path, const WriteOptions& options) {
  const auto image = nrrd_image(volume, options);
  write_atomically(path, [&](std::ostream& out) {
    detail::write_nrrd_header(out, image);
    detail::write_nrrd_values(out, image, volume.voxels());
  });
}

void write_detached(const VolumeView& volume, const std::string& path, const WriteOptions& options) {
  auto image = nrrd_image(volume, options);
  const std::filesystem::path data =
      std::filesystem::path(path).replace_extension(options.compress ? ".raw.gz" : ".raw");
  image.data_file = data.filename().string();
  // The data first: a header never points to nothing.
  write_atomically(data.string(), [&](std::ostream& out) { detail::write_nrrd_values(out, image, volume.voxels()); });
  write_atomically(path, [&](std::ostream& out) { detail::write_nrrd_header(out, image); });
}

void write_headerless(const VolumeView& volume, const std::string& path) {
  const auto layout = detail::parse_raw_name(path);
  if (!layout || layout->size != volume.lattice().size) {
    const auto stem = std::filesystem::path(path).stem().string();
    const RawLayout own{.size = volume.lattice().size, .type = volume.stored_type(), .big_endian = false};
    throw InvalidInput(fmt::format("{}: a headerless file must say its size and type in its name: {}{}", path, stem,
                                   detail::raw_name_end(own)));
  }
  write_atomically(path, [&](std::ostream& out) {
    detail::encode_scalars(volume.voxels(), layout->type, [&](std::span<const std::byte> bytes) {
      out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    });
  });
}

}  // namespace

void write_volume(const VolumeView& volume, const std::string& path, const WriteOptions& options) {
  if (detail::has_extension(path, ".nrrd")) return write_attached(volume, path, options);
  if (detail::has_extension(path, ".nhdr")) return write_detached(volume, path, options);
  if (detail::has_extension(path, ".raw")) return write_headerless(volume, path);
  throw InvalidInput(fmt::format("{}: volumes can be written as .nrrd, .nhdr and name_WxHxD_type.raw", path));
}

}  // namespace isolux
