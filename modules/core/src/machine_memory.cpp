#include <isolux/core/machine_memory.h>
#include <unistd.h>

#include <limits>

namespace isolux {

double machine_memory() {
  const double bytes = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
  return bytes > 0.0 ? bytes : std::numeric_limits<double>::infinity();
}

}  // namespace isolux
