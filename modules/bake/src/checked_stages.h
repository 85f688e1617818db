#pragma once

#include <isolux/bake/bake.h>

#include <memory>

namespace isolux {

/// The sampler of anybody's that is asked for. Its sites are held to lie in the box and to be numbers: it throws
/// InvalidInput naming the sampler and the site otherwise.
[[nodiscard]] std::unique_ptr<const SiteSampler> checked_sampler(const BackendChoice& choice, const Stages& stages);

/// The tracer of anybody's that is asked for. It throws InvalidInput naming the tracer unless there is one sample a
/// site.
[[nodiscard]] std::unique_ptr<const FlatTracer> checked_tracer(const BackendChoice& choice, const Stages& stages);

}  // namespace isolux
