#include "output_files.h"

#include <fmt/format.h>
#include <isolux/volume_io/atomic_file.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "session.h"

namespace isolux {
namespace {
namespace fs = std::filesystem;

/// What a word of the command line came to.
struct NamedFiles {
  std::string name;
  std::vector<std::string> paths;
  std::vector<std::string> places;  ///< of each path, whatever links lead there; "" for devices and pipes
  InPlace in_place = InPlace::kRefused;
};

std::string place_of(const std::string& path) {
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error)) return {};
  return fs::weakly_canonical(fs::absolute(written_file(path), error), error).string();
}

std::vector<NamedFiles> given(const std::vector<FileOption>& options) {
  std::vector<NamedFiles> files;
  for (const FileOption& option : options) {
    files.push_back({option.name, option.paths(), {}, option.in_place});
    for (const std::string& path : files.back().paths) files.back().places.push_back(place_of(path));
  }
  return files;
}

/// The number of the first file of `one` that is a file of `other`.
std::optional<std::size_t> shared_file(const NamedFiles& one, const NamedFiles& other) {
  const std::set<std::string> taken(other.places.begin(), other.places.end());
  for (std::size_t i = 0; i < one.places.size(); ++i)
    if (!one.places[i].empty() && taken.count(one.places[i]) > 0) return i;
  return std::nullopt;
}

/// \throw UsageError
void require_kept(const NamedFiles& output, const NamedFiles& input) {
  if (output.paths.empty() || input.paths.empty()) return;
  const bool may_replace = output.in_place == InPlace::kAllowed && !output.places[0].empty();
  if (may_replace && output.places[0] == input.places[0]) return;
  if (const auto shared = shared_file(output, input))
    throw UsageError(
        fmt::format("{} = '{}': it would replace {}, which is read", output.name, output.paths[*shared], input.name));
}

/// \throw UsageError
void require_apart(const NamedFiles& one, const NamedFiles& other) {
  if (const auto shared = shared_file(one, other))
    throw UsageError(fmt::format("{} = '{}': {} is written there", one.name, one.paths[*shared], other.name));
}

/// Links may lead two names to one file. \throw UsageError
void require_apart(const NamedFiles& output) {
  std::set<std::string> taken;
  for (std::size_t i = 0; i < output.paths.size(); ++i)
    if (!output.places[i].empty() && !taken.insert(output.places[i]).second)
      throw UsageError(fmt::format("{} = '{}': another of its files is written there", output.name, output.paths[i]));
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
    require_apart(*output);
    for (const std::string& path : output->paths) require_writable(path);
  }
}

}  // namespace isolux
