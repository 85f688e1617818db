#pragma once

#include <string>
#include <vector>

namespace isolux {

/// A file and the option that names it, for messages.
struct NamedFile {
  std::string option;
  std::string path;
};

/// Finds out before the work that a result would have no place: every file of `written` (empty paths aside) can be
/// written, no two options name one file, and none replaces a file of `read`. Devices and pipes may be shared.
/// \throw IoError, UsageError
void require_output_files(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read);

}  // namespace isolux
