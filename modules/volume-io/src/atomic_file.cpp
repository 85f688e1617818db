#include <fcntl.h>
#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/atomic_file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <ext/stdio_filebuf.h>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

namespace isolux {
namespace {
namespace fs = std::filesystem;

constexpr std::size_t kLongestEnd = 100;
constexpr int kMostLinks = 40;  // as many as Linux follows

// The temporary files that there are. Whoever holds the mutex keeps others from coming and going.
struct Begun {
  std::mutex mutex;
  std::vector<fs::path> paths;
};

Begun& begun() {
  static auto& all = *new Begun;  // never destroyed: threads may still write while the program ends
  return all;
}

// A file beside `target` that nobody else has, removed unless renamed. Its mode is that of the file there, or follows
// the umask. Libraries choose the format by the end of its name, which is that of `name`.
class Temporary {
 public:
  explicit Temporary(const fs::path& target) : Temporary(target, target) {}
  Temporary(const fs::path& target, const fs::path& name) : target_(target) {
    static std::atomic<unsigned> counter{0};
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    std::error_code error;
    if (!fs::is_directory(folder, error))
      throw IoError(fmt::format("{}: there is no folder {}", target.string(), folder.string()));
    if (const long most = pathconf(folder.c_str(), _PC_NAME_MAX);
        most > 0 && target.filename().string().size() > std::size_t(most))
      throw IoError(fmt::format("{}: cannot be written: {}", target.string(), std::strerror(ENAMETOOLONG)));
    if (fs::is_directory(target, error)) throw IoError(fmt::format("{}: a directory", target.string()));
    if (fs::exists(target, error) && access(target.c_str(), W_OK) != 0)
      throw IoError(fmt::format("{}: cannot be written: {}", target.string(), std::strerror(errno)));
    std::string end = name.filename().string();
    if (end.size() > kLongestEnd) end.erase(0, end.size() - kLongestEnd);
    const std::lock_guard lock(begun().mutex);
    for (int attempt = 0; attempt < 100; ++attempt) {
      path_ = folder / fmt::format(".isolux-{}-{}-{}", getpid(), counter++, end);
      const int file = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (file >= 0) {
        // Who hid the file that is replaced hides the new one.
        struct stat old {};
        if (stat(target.c_str(), &old) == 0 && S_ISREG(old.st_mode))
          static_cast<void>(fchmod(file, old.st_mode & 0777u));
        close(file);
        begun().paths.push_back(path_);
        return;
      }
      if (errno != EEXIST) break;
    }
    throw IoError(fmt::format("{}: cannot be written: {}", target.string(), std::strerror(errno)));
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    if (path_.empty()) return;
    const std::lock_guard lock(begun().mutex);
    std::error_code ignored;
    fs::remove(path_, ignored);
    std::erase(begun().paths, path_);
  }

  [[nodiscard]] const fs::path& path() const { return path_; }

  void rename_to_target() {
    const std::lock_guard lock(begun().mutex);
    std::error_code error;
    fs::rename(path_, target_, error);
    if (error) throw IoError(fmt::format("{}: cannot be written: {}", target_.string(), error.message()));
    std::erase(begun().paths, path_);
    path_.clear();
  }

 private:
  fs::path target_;
  fs::path path_;
};

// Whether names in a folder are those of open files, as in /dev/fd: links there lead to no names.
bool names_open_files(const fs::path& folder) {
  std::error_code error;
  const fs::path real = fs::canonical(folder, error);
  return !error && real.filename() == "fd" && real.string().starts_with("/proc/");
}

// The number of the open file of this process that a path names (/dev/stdout): what is written there goes on where
// others have come to, also in a regular file.
std::optional<int> descriptor_of(const fs::path& target) {
  std::error_code error;
  const std::string name = target.filename().string();
  if (name.empty() || name.size() > 9 || name.find_first_not_of("0123456789") != std::string::npos) return {};
  if (!fs::equivalent(target.parent_path(), "/proc/self/fd", error)) return {};
  return std::stoi(name);
}

void fill_open_file(int descriptor, const std::string& path, const std::function<void(std::ostream&)>& write) {
  const int own = fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
  if (own < 0) throw IoError(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  __gnu_cxx::stdio_filebuf<char> buffer(own, std::ios::out | std::ios::binary);
  std::ostream stream(&buffer);
  errno = 0;
  write(stream);
  if (buffer.close() == nullptr || !stream)
    throw IoError(fmt::format("{}: writing failed: {}", path, reason_of(errno)));
}

void fill(const fs::path& file, const std::string& path, const std::function<void(std::ostream&)>& write) {
  if (const auto descriptor = descriptor_of(file)) return fill_open_file(*descriptor, path, write);
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  if (!stream) throw IoError(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  errno = 0;
  write(stream);
  stream.close();
  if (!stream) throw IoError(fmt::format("{}: writing failed: {}", path, reason_of(errno)));
}

// A pipe or a device (/dev/stdout, /dev/null) is written to, never replaced.
bool is_special(const fs::path& target) {
  std::error_code error;
  if (descriptor_of(target)) return true;
  const fs::file_status status = fs::status(target, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

// For a library that opens files by name, which would begin an open one anew.
void write_by_way_of_a_file(int descriptor, const std::string& path,
                            const std::function<void(const std::string& temporary)>& write) {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  if (error) throw IoError(fmt::format("{}: no folder for a temporary file: see TMPDIR", path));
  std::ifstream content;
  {
    const Temporary file(folder / fs::path(path).filename());
    write(file.path().string());
    content.open(file.path(), std::ios::binary);
  }  // and is removed before a reader goes away, which ends the program at once
  if (!content) throw IoError(fmt::format("{}: its temporary file cannot be read", path));
  fill_open_file(descriptor, path, [&](std::ostream& out) {
    if (content.peek() != std::ifstream::traits_type::eof()) out << content.rdbuf();
  });
}

// What went wrong with a temporary went wrong with the file that the user named.
std::string with_name(std::string message, const std::string& temporary, const std::string& path) {
  const auto at = message.find(temporary);
  return at == std::string::npos ? message : message.replace(at, temporary.size(), path);
}

}  // namespace

std::string written_file(const std::string& path) {
  // Not canonical(): a link may lead to a file that is not there yet.
  fs::path target = path;
  std::error_code error;
  for (int links = 0; fs::is_symlink(target, error) && !names_open_files(target.parent_path()); ++links) {
    const fs::path next = fs::read_symlink(target, error);
    if (error || links == kMostLinks) throw IoError(fmt::format("{}: a symbolic link that cannot be followed", path));
    target = target.parent_path() / next;
  }
  return target.string();
}

std::unique_lock<std::mutex> remove_temporary_files() {
  std::unique_lock lock(begun().mutex);
  std::error_code ignored;
  for (const fs::path& path : begun().paths) fs::remove(path, ignored);
  return lock;
}

void require_writable(const std::string& path) {
  const fs::path target = written_file(path);
  if (!is_special(target)) {
    Temporary removed(target);
  } else if (access(target.c_str(), W_OK) != 0) {
    throw IoError(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  }
}

void write_atomically(const std::string& path, const std::function<void(std::ostream&)>& write) {
  const fs::path target = written_file(path);
  if (is_special(target)) return fill(target, path, write);
  Temporary temporary(target);
  fill(temporary.path(), path, write);
  temporary.rename_to_target();
}

void write_atomically_by_name(const std::string& path, const std::function<void(const std::string& temporary)>& write) {
  const fs::path target = written_file(path);
  if (const auto descriptor = descriptor_of(target)) return write_by_way_of_a_file(*descriptor, path, write);
  if (is_special(target)) return write(path);
  Temporary temporary(target, path);
  const std::string name = temporary.path().string();
  try {
    write(name);
  } catch (const IoError& error) {
    throw IoError(with_name(error.what(), name, path));
  }
  temporary.rename_to_target();
}

}  // namespace isolux
