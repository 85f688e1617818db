#pragma once

#include "scalars.h"

#include <isolux/volume_io/volume_reader.h>

#include <string>
#include <vector>

namespace isolux::detail {

/// What a header, read by us, promises; a library's result is held against it.
struct CheckedHeader {
  Index3 size{0};
};

/// Each `is_` tells a format by its content. Each `check_` reads the header on its own and makes sure that the file
/// holds the data promised, that spacing and frame are finite and that no data file lies outside the header's folder:
/// ITK 5.2 takes truncated and absurd files for good ones. \throw IoError, InvalidInput naming the file, the value and
/// what is allowed
[[nodiscard]] bool is_nifti(const std::string& path);
[[nodiscard]] CheckedHeader check_nifti(const std::string& path);
/// What the name of such a file has to end in for ITK: it tells compression by that.
[[nodiscard]] std::string_view nifti_extension(const std::string& path);

[[nodiscard]] bool is_meta_image(const std::string& path);
[[nodiscard]] CheckedHeader check_meta_image(const std::string& path, const ReadOptions& options);
/// The file that holds the data: `path` itself where they are attached. \throw as check_meta_image
[[nodiscard]] std::string meta_image_data_file(const std::string& path, const ReadOptions& options);

[[nodiscard]] bool is_legacy_vtk(const std::string& path);
[[nodiscard]] CheckedHeader check_legacy_vtk(const std::string& path);

/// The size's z is the number of pages.
[[nodiscard]] bool is_tiff(const std::string& path);
[[nodiscard]] CheckedHeader check_tiff(const std::string& path);

/// One slice.
[[nodiscard]] bool is_dicom(const std::string& path);
[[nodiscard]] CheckedHeader check_dicom(const std::string& path);

/// Files of a folder told by `is`, in the order in which people number them ("s2" before "s10").
[[nodiscard]] std::vector<std::string> files_in_folder(const std::string& folder, bool (*is)(const std::string&));

/// Bytes that a gzip or zlib stream at `offset` inflates to, counted up to `most`. \throw IoError for damaged data
[[nodiscard]] std::uint64_t inflated_bytes(const std::string& path, std::uint64_t offset, std::uint64_t most);

/// \throw InvalidInput unless every number is finite and, for a spacing, not zero
void require_finite(const std::string& path, std::string_view what, std::span<const double> numbers);
void require_spacing(const std::string& path, std::span<const double> numbers);

}  // namespace isolux::detail
