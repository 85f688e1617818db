#pragma once

#include <isolux/core/volume.h>

#include <optional>
#include <string>
#include <vector>

namespace isolux::detail {

/// One image of a series: its pixels' lattice, of size 1 on the third axis.
struct Slice {
  std::string path;
  Lattice lattice;
  ScalarType type = ScalarType::kInt16;
};

struct SliceStack {
  Lattice lattice;
  std::string remark;  ///< where the caller's spacing overrules gaps that are not even; else empty
};

/// Sorts slices that stand one behind another and gives their common lattice. Its third axis is the step from slice to
/// slice, which a tilted gantry makes oblique to them; with a spacing from the caller (`gap`, world units) they are
/// taken as that far apart in the order of their places, from the first towards the last, or along their
/// normal where that is nowhere near it. \throw InvalidInput naming
/// `source` if they differ in size, spacing or direction, or are not evenly spaced: then it says whether two lie at the
/// same place, one is missing, or which gaps are the smallest and the largest. \pre there is at least one
[[nodiscard]] SliceStack stack_slices(const std::string& source, std::vector<Slice>& slices, std::optional<double> gap);

}  // namespace isolux::detail
