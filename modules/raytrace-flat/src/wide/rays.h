#pragma once

#include <isolux/core/field.h>
#include <isolux/core/vec.h>
#include <isolux/raytrace_flat/flat_tracer.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace isolux::wide {

/// Lanes that any instruction set may read or write beyond the end of a ray array.
inline constexpr std::size_t kPadding = 64;

/// The parameter of a ray that meets nothing.
inline constexpr float kEscaped = std::numeric_limits<float>::infinity();

/// A batch of rays, each starting on its own level set; structure of arrays, index space. Arrays have `kPadding` values
/// to spare.
struct Rays {
  std::size_t count = 0;
  std::vector<float> origin[3];
  std::vector<float> direction[3];  ///< any length
  std::vector<float> isovalue;
  std::vector<std::uint32_t> doubtful;  ///< rays that single precision cannot answer
  std::vector<std::uint32_t> vague;     ///< hits whose place it cannot tell well; their t is in the cell of the hit
  std::vector<float> t;  ///< answer, in lengths of the direction: 0 if blocked at the start, kEscaped if nothing is met

  explicit Rays(std::size_t capacity) {
    for (auto& axis : origin) axis.resize(capacity + kPadding);
    for (auto& axis : direction) axis.resize(capacity + kPadding);
    isovalue.resize(capacity + kPadding);
    t.resize(capacity + kPadding);
  }
  [[nodiscard]] std::size_t capacity() const { return t.size() - kPadding; }
};

/// What is asked of a ray.
enum class Question : std::uint8_t {
  kAnyHit,   ///< does it meet its level set? t is 0 if so
  kFirstHit  ///< where first?
};

/// The field as the kernels see it: x fastest.
struct FieldView {
  const float* values = nullptr;
  Index3 size{0};
  OuterSide outer = OuterSide::kLower;
};

/// The upper byte of an occupancy's words of empty bricks.
inline constexpr std::uint32_t kEmptyBrick = 0x5A000000u;
inline constexpr std::uint32_t kUpperByte = 0xFF000000u;

/// Where the level sets of a range of isovalues may be: two words a brick of 4^3 cells, the halves z < 2 and z >= 2.
/// Both of an empty brick begin with kEmptyBrick; for each octant o of directions (bit a of o: axis a runs backwards),
/// they have three bits at 3 o: the code c of a cube of c + 1 + max(0, c - 3) empty bricks on a side that begins with
/// this one and reaches that way (what lies outside of the volume is empty). In other bricks bit x + 4 y + 16 z of a
/// cell is set where it is occupied; a half whose upper byte would be kEmptyBrick has a cell more for occupied.
struct OccupancyView {
  const std::uint32_t* words = nullptr;
  Index3 bricks{0};
  float threshold = -std::numeric_limits<float>::infinity();  ///< holds from this isovalue on towards the inner side
};

/// Where a ray has certainly met its level set: a bit for each cube of 2^3 cells, x fastest, set where all its corner
/// values lie on the inner side of every isovalue up to the ceiling, by more than a rounding.
struct InnerView {
  const std::uint32_t* bits = nullptr;  ///< none: nothing is known
  Index3 cubes{0};                      ///< on x a multiple of 32; cubes that stick out of the volume are left out
  float ceiling = 0.0f;                 ///< holds up to this isovalue (with the outer side of higher values: negated)
};

/// Answers every ray of the batch. The occupancy must have every cell's bit set that a level set of one of the rays
/// passes. Each answer depends on its own ray alone. Cost: some 20 leaps and 4 cell tests a ray.
void trace(const FieldView& field, const OccupancyView& occupancy, const InnerView& inner, Question question,
           Rays& rays, TraceCounters& counters);

}  // namespace isolux::wide
