#include "byte_source.h"
#include "files.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/read.h>

#include <cmath>
#include <new>
#include <stdexcept>

namespace isolux {
namespace {

constexpr std::string_view kFormats =
    "gen:NAME[:N], NRRD (.nrrd, .nhdr), NIfTI (.nii, .nii.gz), MetaImage (.mha, .mhd), MRC (.mrc, .map, also .gz), "
    "VTK image data (.vti, legacy .vtk), NumPy arrays (.npy), TIFF stacks, folders of DICOM slices, and "
    "name_WxHxD_type.raw";

/// \throw InvalidInput, IoError: nobody claims the source
[[noreturn]] void refuse(const std::string& source, const std::string& missing) {
  if (!detail::is_directory(source)) (void)detail::require_file(source);
  if (detail::is_gzip(source))
    throw InvalidInput(fmt::format(
        "{}: gzip of no volume that can be read: known are gzip of NIfTI (.nii.gz) and MRC (.mrc.gz, .map.gz); "
        "unpack what is something else",
        source));
  throw InvalidInput(
      fmt::format("{}: not a volume that can be read: known are {}{}; --dims and --type read any other file as "
                  "headerless",
                  source, kFormats, missing));
}

/// \throw InvalidInput, IoError if nobody claims the source
std::unique_ptr<VolumeReader> reader_of(const std::string& source, const ReadOptions& options,
                                        const Registry<VolumeReader>& registry) {
  for (const auto& [name, settings] : options.settings)
    if (!settings.empty()) static_cast<void>(registry.info(name));  // there is nobody else to say that it is not there
  std::unique_ptr<VolumeReader> best;
  int best_claim = 0;
  std::string missing;
  for (const auto& info : registry.backends()) {
    if (!info.unavailable.empty()) {
      missing += fmt::format("; {}: {}", info.name, info.unavailable);
      continue;
    }
    const auto settings = options.settings.find(info.name);
    auto reader = registry.create(info.name, settings != options.settings.end() ? settings->second : Settings{});
    const int claim = reader->claims(source, options);
    if (claim <= best_claim) continue;
    best = std::move(reader);
    best_claim = claim;
  }
  if (best == nullptr) refuse(source, missing);
  return best;
}

StoredVolume read_in_form(const std::string& source, ReadOptions options, VoxelForm form, const Run& run,
                          const Registry<VolumeReader>& registry) {
  if (!std::isfinite(options.subtract))
    throw InvalidInput(fmt::format("ReadOptions::subtract = {}: allowed are finite numbers", options.subtract));
  options.form = form;
  const auto reader = reader_of(source, options, registry);
  try {
    return reader->read(source, options, run);
  } catch (const std::bad_alloc&) {
    throw IoError(fmt::format("{}: the memory does not suffice for so many voxels", source));
  } catch (const std::length_error&) {
    throw IoError(fmt::format("{}: the memory does not suffice for so many voxels", source));
  }
}

}  // namespace

Volume read_volume(const std::string& source, const ReadOptions& options, const Run& run,
                   const Registry<VolumeReader>& registry) {
  return to_floats(read_in_form(source, options, VoxelForm::kFloats, run, registry));
}

Volume read_volume(const std::string& source, const ReadOptions& options, const Run& run) {
  return read_volume(source, options, run, readers());
}

StoredVolume read_stored_volume(const std::string& source, const ReadOptions& options, const Run& run,
                                const Registry<VolumeReader>& registry) {
  return read_in_form(source, options, VoxelForm::kStored, run, registry);
}

StoredVolume read_stored_volume(const std::string& source, const ReadOptions& options, const Run& run) {
  return read_stored_volume(source, options, run, readers());
}

std::vector<std::string> volume_files(const std::string& source, const ReadOptions& options,
                                      const Registry<VolumeReader>& registry) {
  try {
    return reader_of(source, options, registry)->files(source, options);
  } catch (const Error&) {
    return {source};
  }
}

std::vector<std::string> volume_files(const std::string& source, const ReadOptions& options) {
  return volume_files(source, options, readers());
}

bool takes_layout(const std::string& source, const ReadOptions& options, const Registry<VolumeReader>& registry) {
  return reader_of(source, options, registry)->takes_layout();
}

bool takes_layout(const std::string& source, const ReadOptions& options) {
  return takes_layout(source, options, readers());
}

}  // namespace isolux
