#include <isolux/core/error.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace isolux {
namespace {

std::string without_control_characters(std::string text) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7F; };
  std::replace_if(text.begin(), text.end(), is_control, ' ');
  return text;
}

}  // namespace

Error::Error(std::string message) : std::runtime_error(without_control_characters(std::move(message))) {}

std::string reason_of(int error_number) {
  return error_number == 0 ? "the disk may be full" : std::strerror(error_number);
}

}  // namespace isolux
