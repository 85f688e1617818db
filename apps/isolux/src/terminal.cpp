#include "terminal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <isolux/core/error.h>

#include <cerrno>
#include <cstdio>

namespace isolux {
namespace {
constexpr std::size_t kLongestMessage = 1000;

/// \throw IoError with what errno says
[[noreturn]] void refuse_output() {
  throw IoError(fmt::format("standard output: writing failed: {}", reason_of(errno)));
}

void blank_control_characters(std::string& text) {
  for (char& c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7F) c = ' ';
  }
}
}  // namespace

void open_standard_streams() {
  // open() takes the lowest number that is free.
  for (int stream = 0; stream <= 2; ++stream) {
    if (fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    static_cast<void>(open("/dev/null", stream == 1 ? O_RDONLY : O_RDWR));
  }
}

void tell(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void complain(const std::string& what, std::string why) {
  // The line of a binary file that was read as a header may be endless.
  if (why.size() > kLongestMessage) why.replace(kLongestMessage / 2, why.size() - kLongestMessage, " ... ");
  blank_control_characters(why);
  tell(fmt::format("isolux: error: {}: {}\n", what, why));
}

void warn(std::string what) {
  blank_control_characters(what);
  tell(fmt::format("isolux: warning: {}\n", what));
}

void put_out(const std::string& text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) refuse_output();
}

void flush_output() {
  errno = 0;
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) refuse_output();
}

}  // namespace isolux
