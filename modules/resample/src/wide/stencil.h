#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace isolux::wide {

/// The points of a lattice around one, nearest first.
struct Stencil {
  /// Points along x, so many to either side of the one in the middle.
  struct Row {
    int y;
    int z;
    int reach;
  };
  struct Member {
    std::array<int, 3> step;
    std::array<float, 3> place;  ///< relative to the middle
    std::size_t row;
    std::size_t along;  ///< from where its row begins
  };
  /// Members nearly as far away as each other: within a sixteenth of an octave of the squared distance.
  struct Shell {
    std::size_t end;   ///< one past the last of them
    std::size_t rows;  ///< so many of the first rows hold them and those before
    float distance;    ///< their mean
  };
  static constexpr std::size_t kMostMembers = 2109;  ///< where steps are the same, so many are within eight of them
  static constexpr std::size_t kLargestShell = 96;

  std::vector<Row> rows;
  std::vector<Member> members;
  std::vector<Shell> shells;

  int reach = 0;  ///< the longest of the rows'

  /// For steps so long along the axes, in a box of so many points: what is never in it is left out.
  static Stencil of(const std::array<double, 3>& steps, const std::array<int, 3>& size);
};

}  // namespace isolux::wide
