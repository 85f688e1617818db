#include "output_files.h"

#include <fmt/format.h>
#include <isolux/volume_io/atomic_file.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "session.h"

namespace isolux {
namespace {
namespace fs = std::filesystem;

/// What a word of the command line came to.
struct NamedFiles {
  std::string name;
  std::vector<std::string> paths;
  InPlace in_place = InPlace::kRefused;
};

std::vector<NamedFiles> given(const std::vector<FileOption>& options) {
  std::vector<NamedFiles> files;
  for (const FileOption& option : options) files.push_back({option.name, option.paths(), option.in_place});
  return files;
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::exists(a, error) && !fs::is_regular_file(a, error)) return false;
  const fs::path real_a = fs::weakly_canonical(fs::absolute(written_file(a), error), error);
  const fs::path real_b = fs::weakly_canonical(fs::absolute(written_file(b), error), error);
  return real_a == real_b;
}

/// \throw UsageError
void require_kept(const NamedFiles& output, const NamedFiles& input) {
  if (output.paths.empty() || input.paths.empty()) return;
  if (output.in_place == InPlace::kAllowed && same_file(output.paths[0], input.paths[0])) return;
  for (const std::string& path : output.paths) {
    const auto is_path = [&](const std::string& read) { return same_file(path, read); };
    if (std::any_of(input.paths.begin(), input.paths.end(), is_path))
      throw UsageError(fmt::format("{} = '{}': it would replace {}, which is read", output.name, path, input.name));
  }
}

/// \throw UsageError
void require_apart(const NamedFiles& one, const NamedFiles& other) {
  for (const std::string& path : one.paths)
    for (const std::string& taken : other.paths)
      if (same_file(path, taken))
        throw UsageError(fmt::format("{} = '{}': {} is written there", one.name, path, other.name));
}

}  // namespace

FileOption file_of(const CLI::Option* option) {
  return {.name = option->get_name(),
          .paths = [option] { return std::vector<std::string>(option->results()); },
          .in_place = InPlace::kRefused};
}

void require_output_files(const std::vector<FileOption>& written, const std::vector<FileOption>& read) {
  const std::vector<NamedFiles> outputs = given(written);
  const auto none = [](const NamedFiles& output) { return output.paths.empty(); };
  if (std::all_of(outputs.begin(), outputs.end(), none)) return;  // headers of inputs need not be looked into
  const std::vector<NamedFiles> inputs = given(read);
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    for (const NamedFiles& input : inputs) require_kept(*output, input);
    for (auto before = outputs.begin(); before != output; ++before) require_apart(*output, *before);
    for (const std::string& path : output->paths) require_writable(path);
  }
}

}  // namespace isolux
