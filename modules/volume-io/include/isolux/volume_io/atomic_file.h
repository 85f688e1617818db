#pragma once

#include <functional>
#include <mutex>
#include <ostream>
#include <string>

namespace isolux {

/// The file that writing to `path` replaces: symbolic links are followed, also to a file that is not there, and stay.
/// Open files (/dev/stdout, /dev/fd/N) keep their names there.
/// \throw IoError for links in a circle
[[nodiscard]] std::string written_file(const std::string& path);

/// Finds out before long work whether `path` can be written as below; leaves nothing behind. \throw IoError naming path
void require_writable(const std::string& path);

/// Lets `write` fill a temporary file in the folder of `path`, then renames it to `path`: a reader never sees half a
/// file, and nothing is left if anything throws. A file that is replaced leaves its mode. Pipes, devices and open files
/// are written to as they are. \throw IoError naming path; whatever write throws.
void write_atomically(const std::string& path, const std::function<void(std::ostream&)>& write);

/// The same for a library that wants a file name: `write` gets the temporary's path, which keeps the extension of
/// `path`, wherever links lead. An IoError of `write` that names the temporary names `path` instead.
void write_atomically_by_name(const std::string& path, const std::function<void(const std::string& temporary)>& write);

/// Removes the temporary files of this process, for a program that has to end at once. While the lock lives, none is
/// made or renamed.
[[nodiscard]] std::unique_lock<std::mutex> remove_temporary_files();

}  // namespace isolux
