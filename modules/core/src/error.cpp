#include <isolux/core/error.h>

#include <cstring>

namespace isolux {

std::string reason_of(int error_number) {
  return error_number == 0 ? "the disk may be full" : std::strerror(error_number);
}

}  // namespace isolux
