#include "output_files.h"

#include <fmt/format.h>
#include <isolux/volume_io/atomic_file.h>

#include <filesystem>

#include "session.h"

namespace isolux {
namespace {
namespace fs = std::filesystem;

bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::exists(a, error) && !fs::is_regular_file(a, error)) return false;
  const fs::path real_a = fs::weakly_canonical(fs::absolute(a, error), error);
  const fs::path real_b = fs::weakly_canonical(fs::absolute(b, error), error);
  return real_a == real_b;
}

}  // namespace

void require_output_files(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read) {
  for (std::size_t i = 0; i < written.size(); ++i) {
    const auto& [option, path] = written[i];
    if (path.empty()) continue;
    for (const NamedFile& input : read) {
      if (!input.path.empty() && same_file(path, input.path))
        throw UsageError(fmt::format("{} = '{}': it would replace {}, which is read", option, path, input.option));
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (!written[j].path.empty() && same_file(path, written[j].path))
        throw UsageError(fmt::format("{} = '{}': {} is written there", option, path, written[j].option));
    }
    require_writable(path);
  }
}

}  // namespace isolux
