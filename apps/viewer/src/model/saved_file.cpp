#include "model/saved_file.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/atomic_file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace isolux::viewer {
namespace {

namespace fs = std::filesystem;

/// Bytes of a stem: with isovalue, number and extension a name stays below the 255 of common file systems.
constexpr std::size_t kLongestStem = 200;

std::string stem_of(const std::string& volume_name) {
  std::string stem = fs::path(volume_name).stem().string();
  if (stem.empty()) stem = "volume";
  if (stem.size() > kLongestStem) {
    std::size_t end = kLongestStem;
    while (end > 0 && (static_cast<unsigned char>(stem[end]) & 0xC0) == 0x80) --end;  // whole UTF-8 characters
    stem.resize(end);
  }
  for (char& c : stem) {
    if (c == ':') c = '_';
  }
  return stem;
}

/// Gives the file another name, unless that exists. A link fails where a rename would overwrite.
bool claim(const std::string& file, const std::string& name) {
  if (link(file.c_str(), name.c_str()) == 0) return true;
  if (errno == EEXIST) return false;
  // Some file systems have no links.
  std::error_code error;
  if (fs::exists(fs::symlink_status(name, error))) return false;
  fs::rename(file, name, error);
  if (error) throw IoError(fmt::format("{}: cannot be written: {}", name, error.message()));
  return true;
}

/// Removed when it goes: linked or renamed by then, unless something was thrown.
struct Draft {
  std::string path;
  ~Draft() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
};

}  // namespace

std::string save_under_free_name(const std::string& volume_name, double isovalue, const std::string& extension,
                                 const std::function<void(const std::string& path)>& write) {
  const std::string stem = fmt::format("{}-{:.6g}", stem_of(volume_name), isovalue);
  std::string name = fmt::format("{}.{}", stem, extension);
  const Draft draft{fmt::format(".isolux-view-{}.{}", getpid(), extension)};
  try {
    write_atomically_by_name(draft.path, write);
  } catch (const IoError& error) {
    std::string what = error.what();
    if (const auto at = what.find(draft.path); at != std::string::npos) what.replace(at, draft.path.size(), name);
    throw IoError(what);
  }
  for (int i = 2; !claim(draft.path, name); ++i) name = fmt::format("{}-{}.{}", stem, i, extension);
  return name;
}

}  // namespace isolux::viewer
