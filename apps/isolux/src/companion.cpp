#include "companion.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace isolux {
namespace {

/// One word of the shell's.
std::string quoted(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + "'";
}

}  // namespace

std::string find_companion(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  if (error) return {};
  // Installed side by side; in a build tree apps/isolux/isolux, apps/viewer/isolux-view and apps/bench/isolux-bench.
  for (const fs::path& candidate : {folder / name, folder / "../viewer" / name, folder / "../bench" / name}) {
    if (fs::is_regular_file(candidate, error) && access(candidate.c_str(), X_OK) == 0) return candidate.string();
  }
  return {};
}

void run_companion(const std::string& name, const std::vector<std::string>& arguments) {
  const std::string path = find_companion(name);
  if (path.empty()) {
    throw IoError(fmt::format("{} is not installed beside isolux; this build left it out", name));
  }
  std::vector<std::string> copy{path};
  copy.insert(copy.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (auto& argument : copy) argv.push_back(argument.data());
  argv.push_back(nullptr);
  // Interrupts stay blocked, so that none is lost before the companion watches for them as this program has.
  execv(path.c_str(), argv.data());
  throw IoError(fmt::format("{}: cannot start: {}", path, std::strerror(errno)));
}

std::optional<nlohmann::json> companion_json(const std::string& name, const std::string& argument) {
  const std::string path = find_companion(name);
  if (path.empty()) return std::nullopt;
  std::string text;
  std::FILE* pipe = popen(fmt::format("{} {} 2>/dev/null", quoted(path), argument).c_str(), "r");
  if (pipe == nullptr) return std::nullopt;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) text.append(buffer.data(), n);
  if (pclose(pipe) != 0) return std::nullopt;
  auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded()) return std::nullopt;
  return json;
}

}  // namespace isolux
