#pragma once

#include <isolux/core/run.h>
#include <isolux/core/volume.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace isolux {

/// A bit a texel of a lattice.
class TexelMask {
 public:
  /// None of them. \throw InvalidInput for sizes below 0 and more texels than memory can be asked for
  explicit TexelMask(const Index3& size);

  [[nodiscard]] bool operator[](std::size_t texel) const { return (words_[texel / 64] >> texel % 64 & 1) != 0; }
  [[nodiscard]] std::size_t count() const;
  [[nodiscard]] const Index3& size() const { return size_; }
  /// Not for texels of one word from several threads at once.
  void set(std::size_t texel) { words_[texel / 64] |= std::uint64_t(1) << texel % 64; }

 private:
  Index3 size_;
  std::vector<std::uint64_t> words_;
};

/// The texels that the level sets of some isovalues are read from: those between whose neighbours on every axis, or
/// the box's face, the volume takes one of these values. Their own value may be far from them where the field is steep.
/// All where the texels' axes are not the volume's. \pre the volume is usable. Cost: some nanoseconds a texel. \throw
/// Cancelled
[[nodiscard]] TexelMask texels_read_by(const Volume& volume, const Lattice& texels, const ValueRange& isovalues,
                                       const Run& run);

}  // namespace isolux
