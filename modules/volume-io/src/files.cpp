#include "files.h"

#include "plain_text.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace isolux::detail {
namespace fs = std::filesystem;
namespace {
constexpr std::size_t kLongestName = 4096;
}

std::uint64_t require_file(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw IoError(fmt::format("{}: no such file", path));
  if (error) throw IoError(fmt::format("{}: {}", path, error.message()));
  if (fs::is_directory(status)) throw IoError(fmt::format("{}: a directory, not a file", path));
  // A pipe or a device could keep the reader waiting for ever.
  if (!fs::is_regular_file(status)) throw IoError(fmt::format("{}: not a regular file", path));
  if (access(path.c_str(), R_OK) != 0) throw IoError(fmt::format("{}: {}", path, std::strerror(errno)));
  const std::uint64_t size = fs::file_size(path, error);
  if (error) throw IoError(fmt::format("{}: {}", path, error.message()));
  if (size == 0) throw IoError(fmt::format("{}: the file is empty", path));
  return size;
}

bool is_directory(const std::string& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

std::string first_bytes(const std::string& path, std::size_t count) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {};
  std::string bytes(count, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), std::streamsize(count));
  bytes.resize(std::size_t(std::max<std::streamsize>(file.gcount(), 0)));
  return bytes;
}

bool has_extension(std::string_view path, std::string_view extension) {
  if (path.size() <= extension.size()) return false;
  const std::string_view end = path.substr(path.size() - extension.size());
  return std::equal(end.begin(), end.end(), extension.begin(),
                    [](unsigned char a, unsigned char b) { return std::tolower(a) == b; });
}

std::string resolve_data_file(const std::string& header, const std::string& named, bool allow_external) {
  if (named.size() > kLongestName)
    throw InvalidInput(
        fmt::format("{}: its data file '{}...': a name has {} bytes at most", header, excerpt(named), kLongestName));
  const fs::path folder = fs::absolute(header).parent_path();
  const fs::path data = folder / named;
  std::error_code error;
  const fs::path real_folder = fs::weakly_canonical(folder, error);
  const fs::path real_data = fs::weakly_canonical(data, error);
  if (error) throw IoError(fmt::format("{}: its data file {}: {}", header, named, error.message()));
  const auto [end, unused] = std::mismatch(real_folder.begin(), real_folder.end(), real_data.begin(), real_data.end());
  if (!allow_external && end != real_folder.end()) {
    throw InvalidInput(fmt::format(
        "{}: its data file '{}' lies outside the header's folder; --allow-external-data reads it all the same", header,
        named));
  }
  try {
    (void)require_file(data.string());
  } catch (const IoError& problem) {
    throw IoError(fmt::format("{}: its data file {}", header, problem.what()));
  }
  return data.string();
}

}  // namespace isolux::detail
