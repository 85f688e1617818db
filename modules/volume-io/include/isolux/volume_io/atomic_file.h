#pragma once

#include <functional>
#include <ostream>
#include <string>

namespace isolux {

/// Finds out before long work whether `path` can be written as below; leaves nothing behind. \throw IoError naming path
void require_writable(const std::string& path);

/// Lets `write` fill a temporary file in the folder of `path`, then renames it to `path`: a reader never sees half a
/// file, and nothing is left if anything throws. \throw IoError naming path; whatever write throws.
void write_atomically(const std::string& path, const std::function<void(std::ostream&)>& write);

/// The same for a library that wants a file name: `write` gets the temporary's path, which keeps the extension of
/// `path`. An IoError of `write` that names the temporary names `path` instead.
void write_atomically_by_name(const std::string& path, const std::function<void(const std::string& temporary)>& write);

}  // namespace isolux
