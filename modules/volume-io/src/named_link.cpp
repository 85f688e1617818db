#include "named_link.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace isolux::detail {
namespace {
namespace fs = std::filesystem;
}  // namespace

NamedLink::NamedLink(const std::string& path, std::string_view extension) {
  std::error_code error;
  folder_ = (fs::temp_directory_path(error) / "isolux-XXXXXX").string();
  if (error || mkdtemp(folder_.data()) == nullptr)
    throw IoError(fmt::format("{}: its name should end in {}, and no folder for another name can be made: {}", path,
                              extension, error ? error.message() : std::strerror(errno)));
  link_ = fmt::format("{}/volume{}", folder_, extension);
  fs::create_symlink(fs::absolute(path, error), link_, error);
  if (!error) return;
  fs::remove_all(folder_);
  throw IoError(fmt::format("{}: its name should end in {}, and it cannot be given another one: {}", path, extension,
                            error.message()));
}

NamedLink::~NamedLink() {
  std::error_code ignored;
  fs::remove(link_, ignored);
  fs::remove(folder_, ignored);
}

}  // namespace isolux::detail
