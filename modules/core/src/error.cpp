#include <isolux/core/error.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace isolux {
namespace {

std::string without_zeros(std::string text) {
  std::replace(text.begin(), text.end(), '\0', ' ');
  return text;
}

}  // namespace

Error::Error(std::string message) : std::runtime_error(without_zeros(std::move(message))) {}

std::string reason_of(int error_number) {
  return error_number == 0 ? "the disk may be full" : std::strerror(error_number);
}

}  // namespace isolux
