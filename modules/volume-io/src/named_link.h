#pragma once

#include <string>
#include <string_view>

namespace isolux::detail {

/// A file under another name, for libraries that tell formats by names: a symbolic link in a folder of its own for
/// temporary files, both removed at the end.
class NamedLink {
 public:
  /// \throw IoError naming `path` if there is no place for it
  NamedLink(const std::string& path, std::string_view extension);
  NamedLink(const NamedLink&) = delete;
  NamedLink& operator=(const NamedLink&) = delete;
  ~NamedLink();

  [[nodiscard]] const std::string& path() const { return link_; }

 private:
  std::string folder_;
  std::string link_;
};

}  // namespace isolux::detail
