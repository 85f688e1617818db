#pragma once

#include <CLI/Option.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace isolux {

/// Whether an output may be an input that is written anew.
enum class InPlace : std::uint8_t { kRefused, kAllowed };

/// The files behind one word of the command line, its own first: known once all is parsed, none if it is not given.
struct FileOption {
  std::string name;  ///< for messages
  std::function<std::vector<std::string>()> paths;
  InPlace in_place = InPlace::kRefused;  ///< of outputs; all files of the output may then replace those of the input
};

/// The one file that an option names.
[[nodiscard]] FileOption file_of(const CLI::Option* option);

/// Finds out before the work that a result would have no place: every file of `written` can be written, no two options
/// name one file, and none replaces a file of `read`. Devices and pipes may be shared. \throw IoError, UsageError
void require_output_files(const std::vector<FileOption>& written, const std::vector<FileOption>& read);

}  // namespace isolux
