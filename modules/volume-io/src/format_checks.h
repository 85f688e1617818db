#pragma once

#include "data_place.h"

#include <isolux/volume_io/volume_reader.h>

#include <optional>
#include <string>
#include <vector>

namespace isolux::detail {

/// What a header, read by us, promises; a library's result is held against it.
struct CheckedHeader {
  Index3 size{0};
  std::optional<ScalarType> type;  ///< of the voxels, where the library has to give them in the type that they are in
  std::optional<DataPlace> data;   ///< where we read them better ourselves
  std::string remark{};            ///< what the user should know of it; empty if nothing
};

/// Each `is_` tells a format by its content. Each `check_` reads the header on its own and makes sure that the file
/// holds the data promised, that spacing and frame are finite and that no data file lies outside the header's folder:
/// ITK 5.2 takes truncated and absurd files for good ones. \throw IoError, InvalidInput naming the file, the value and
/// what is allowed
[[nodiscard]] bool is_meta_image(const std::string& path);
[[nodiscard]] CheckedHeader check_meta_image(const std::string& path, const ReadOptions& options);
/// The file that holds the data: `path` itself where they are attached. \throw as check_meta_image
[[nodiscard]] std::string meta_image_data_file(const std::string& path, const ReadOptions& options);

/// The size's z is the number of pages; a remark where they are called something else than sections.
[[nodiscard]] bool is_tiff(const std::string& path);
[[nodiscard]] CheckedHeader check_tiff(const std::string& path);

/// One slice. A spacing from the caller stands in for the file's.
[[nodiscard]] bool is_dicom(const std::string& path);
[[nodiscard]] CheckedHeader check_dicom(const std::string& path, const ReadOptions& options);

/// Files of a folder told by `is`, in the order in which people number them ("s2" before "s10").
[[nodiscard]] std::vector<std::string> files_in_folder(const std::string& folder, bool (*is)(const std::string&));

/// A remark on the first number that the names of a folder's pages, in the order of their numbers, leave out; empty if
/// they leave out none, differ in more than one number, or do not count pages in one step but for such gaps.
[[nodiscard]] std::string missing_page(const std::string& folder, const std::vector<std::string>& files);

/// \throw InvalidInput unless every number is finite and, for a spacing, not zero
void require_finite(const std::string& path, std::string_view what, std::span<const double> numbers);
void require_spacing(const std::string& path, std::span<const double> numbers);

}  // namespace isolux::detail
