#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace isolux::detail {

/// Size in bytes of a regular file. \throw IoError naming the path and why if there is none, if it is a directory or a
/// device, if it may not be read, or if it is empty.
[[nodiscard]] std::uint64_t require_file(const std::string& path);

[[nodiscard]] bool is_directory(const std::string& path);

/// Up to `count` bytes from the start of a regular file; fewer, or none, where there are no more. Never throws.
[[nodiscard]] std::string first_bytes(const std::string& path, std::size_t count);

/// Whether `path` ends in `extension` (lower case, with its dot), in either case.
[[nodiscard]] bool has_extension(std::string_view path, std::string_view extension);

/// The data file that the header at `header` names: relative names are taken from the header's folder.
/// \throw InvalidInput if it lies outside that folder, symbolic links followed, and `allow_external` is not set;
/// IoError as require_file, naming the header.
[[nodiscard]] std::string resolve_data_file(const std::string& header, const std::string& named, bool allow_external);

}  // namespace isolux::detail
