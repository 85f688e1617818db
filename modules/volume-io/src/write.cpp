#include "files.h"
#include "nrrd_header.h"
#include "nrrd_text.h"
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
namespace fs = std::filesystem;

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

/// Whether the NRRD at `header`, if there is one, has its data in `data`.
bool has_data_in(const std::string& header, const fs::path& data) {
  try {
    std::error_code error;
    return fs::equivalent(detail::read_nrrd_header(header, {}).data_file, data, error);
  } catch (const Error&) {
    return false;
  }
}

/// Where a detached header is written: its data lie beside it, however it was named.
std::string header_at(const std::string& path) {
  std::string target = written_file(path);
  return detail::has_extension(target, ".nhdr") ? target : path;
}

/// Beside its header: nobody has named it, so that what is there already may be somebody's only copy.
std::string data_file_of(const std::string& header, const WriteOptions& options) {
  const fs::path data = fs::path(header).replace_extension(options.compress ? ".raw.gz" : ".raw");
  if (!detail::can_be_data_file(data.filename().string()))
    throw InvalidInput(fmt::format(
        "{}: a header cannot name its data file '{}': allowed are names in one line without blanks around them", header,
        data.filename().string()));
  std::error_code error;
  if (fs::exists(data, error) && !has_data_in(header, data))
    throw IoError(fmt::format("{}: its data file {} is there already and belongs to no header of that name", header,
                              data.string()));
  return data.string();
}

void write_detached(const VolumeView& volume, const std::string& path, const WriteOptions& options) {
  auto image = nrrd_image(volume, options);
  const std::string data = data_file_of(header_at(path), options);
  image.data_file = fs::path(data).filename().string();
  std::error_code error;
  const bool was_there = fs::exists(data, error);
  // The data first: a header never points to nothing.
  write_atomically(data, [&](std::ostream& out) { detail::write_nrrd_values(out, image, volume.voxels()); });
  try {
    write_atomically(path, [&](std::ostream& out) { detail::write_nrrd_header(out, image); });
  } catch (...) {
    if (!was_there) fs::remove(data, error);  // which no header names: it would be in the way of the next try
    throw;
  }
}

void write_headerless(const VolumeView& volume, const std::string& path) {
  require_name_of(volume, path);
  const auto layout = detail::parse_raw_name(path);
  write_atomically(path, [&](std::ostream& out) {
    detail::encode_scalars(volume.voxels(), layout->type, [&](std::span<const std::byte> bytes) {
      out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    });
  });
}

}  // namespace

std::vector<std::string> files_written(const std::string& path, const WriteOptions& options) {
  if (detail::has_extension(path, ".nhdr")) return {path, data_file_of(header_at(path), options)};
  if (detail::has_extension(path, ".nrrd") || detail::has_extension(path, ".raw")) return {path};
  throw InvalidInput(fmt::format("{}: volumes can be written as .nrrd, .nhdr and name_WxHxD_type.raw", path));
}

void require_name_of(const VolumeView& volume, const std::string& path) {
  if (!detail::has_extension(path, ".raw")) return;
  const auto layout = detail::parse_raw_name(path);
  const Index3& size = volume.lattice().size;
  if (layout && layout->size == size) return;
  std::string name = fs::path(path).stem().string();
  if (layout) name.erase(name.rfind('_', name.rfind('_') - 1));  // what says another size
  const RawLayout own{.size = size, .type = layout ? layout->type : volume.stored_type(), .big_endian = false};
  throw InvalidInput(fmt::format("{}: a headerless file must say its size and type in its name: {}{}", path, name,
                                 detail::raw_name_end(own)));
}

void write_volume(const VolumeView& volume, const std::string& path, const WriteOptions& options) {
  const Index3& size = volume.lattice().size;
  if (size.x < 1 || size.y < 1 || size.z < 1)
    throw InvalidInput(fmt::format("{}: a volume of {}x{}x{} grid points; every axis needs at least 1 to be written",
                                   path, size.x, size.y, size.z));
  require_spanning(volume.lattice().frame, volume.name());
  static_cast<void>(files_written(path, options));
  if (detail::has_extension(path, ".nrrd")) return write_attached(volume, path, options);
  if (detail::has_extension(path, ".nhdr")) return write_detached(volume, path, options);
  write_headerless(volume, path);
}

}  // namespace isolux
