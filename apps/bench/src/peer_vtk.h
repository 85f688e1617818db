#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace isolux::bench {

/// VTK's Flying Edges with normals on a grid of n^3 floats: seconds of each run after a first one that is not counted;
/// empty where VTK is not in this build. Plain types: VTK 9.1's headers are not C++20.
struct VtkExtraction {
  std::vector<double> seconds;
  std::size_t triangles = 0;
};
[[nodiscard]] VtkExtraction vtk_flying_edges(const std::vector<float>& values, int n, float isovalue, int threads,
                                             int runs);

[[nodiscard]] std::string vtk_version();

}  // namespace isolux::bench
