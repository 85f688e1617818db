#include <isolux/core/release.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace isolux {

void return_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace isolux
