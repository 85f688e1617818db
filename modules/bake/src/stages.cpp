#include <isolux/bake/stages.h>

namespace isolux {

Stages builtin_stages() {
  return {.readers = readers(),
          .extractors = extractors(),
          .samplers = samplers(),
          .tracers = tracers(),
          .resamplers = resamplers()};
}

}  // namespace isolux
