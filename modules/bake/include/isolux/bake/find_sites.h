#pragma once

#include <isolux/bake/bake.h>

namespace isolux {

/// The sites of a bake, and of its result what finding them told. Several bakes of the same level sets can share them.
struct FoundSites {
  Sites sites;
  BakeResult begun;
};

/// The sites that bake() lights. \pre with_defaults(settings) \throw InvalidInput if the volume is not usable, is
/// constant, or no site is found, or the sampler gave one that no tracer takes; Cancelled
[[nodiscard]] FoundSites find_sites(const Volume& volume, OuterSide outer, const BakeSettings& settings,
                                    const Stages& stages, const Run& run);

/// The same sites on the other side of their level sets, bit by bit those that find_sites() gives for it.
[[nodiscard]] FoundSites turned_round(FoundSites found);

}  // namespace isolux
