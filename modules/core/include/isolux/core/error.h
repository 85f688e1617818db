#pragma once

#include <stdexcept>
#include <string>

namespace isolux {

/// Base of everything isolux throws. The message is one line: what was given and what is allowed.
class Error : public std::runtime_error {
 public:
  /// Control characters of a broken file's text become blanks: it would end at a zero, or be several lines.
  explicit Error(std::string message);
};

/// A value, option, name or file content that cannot be used.
class InvalidInput : public Error {
 public:
  using Error::Error;
};

/// A file that could not be opened, read or written.
class IoError : public Error {
 public:
  using Error::Error;
};

/// OpenGL or a window system refused.
class GlError : public Error {
 public:
  using Error::Error;
};

/// The run's stop token was triggered; nothing was written.
class Cancelled : public Error {
 public:
  using Error::Error;
};

/// What the system says of an errno after writing failed; it says nothing (0) where a library noticed.
[[nodiscard]] std::string reason_of(int error_number);

}  // namespace isolux
