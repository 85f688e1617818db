#pragma once

#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/volume_io.h>

#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace isolux::test {

/// A new folder, removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "isolux-test-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }

  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
  [[nodiscard]] std::size_t entries() const {
    return std::size_t(std::distance(std::filesystem::directory_iterator(path_), {}));
  }
  /// Writes a file and returns its path.
  [[nodiscard]] std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(file(name), std::ios::binary) << bytes;
    return file(name);
  }

 private:
  std::filesystem::path path_;
};

inline std::string read_file(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// Numbers one after another as a file has them.
template <class T>
std::string bytes_of(const std::vector<T>& values, bool big_endian = false) {
  std::string bytes;
  for (const T value : values) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    if (big_endian) std::reverse(raw.begin(), raw.end());
    bytes.append(raw.data(), raw.size());
  }
  return bytes;
}

/// Writes a number into bytes at a place.
template <class T>
void put(std::string& bytes, std::size_t offset, T value, bool big_endian = false) {
  bytes.replace(offset, sizeof(T), bytes_of<T>({value}, big_endian));
}

inline std::vector<float> values_of(const Volume& volume) {
  const auto values = volume.values.values();
  return {values.begin(), values.end()};
}

/// The message of the isolux::Error that `f` throws, "" if it throws none. Anything else thrown goes on and fails the
/// test.
template <class F>
std::string error_of(const F& f) {
  try {
    f();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

inline std::string reading_error(const std::string& path, const ReadOptions& options = {}) {
  return error_of([&] { (void)read_volume(path, options); });
}

/// Whether a reader is in this build.
inline bool has_reader(std::string_view name) {
  const auto registry = readers();
  for (const auto& info : registry.backends()) {
    if (info.name == name) return info.unavailable.empty();
  }
  return false;
}

}  // namespace isolux::test
