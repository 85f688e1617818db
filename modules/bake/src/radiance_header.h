#pragma once

#include <isolux/core/vec.h>

#include <string>

namespace isolux {

/// What a Radiance picture's values were multiplied by: all EXPOSURE and COLORCORR lines of its header, per channel.
/// They are divided out for radiance (Radiance's filefmts.pdf, "Header"). \throw InvalidInput for a factor that is not
/// a finite number above 0, values other than 32-bit_rle_rgbe, and rows that do not run from left to right and
/// downwards; IoError where the header is broken off, for which stb would wait for ever.
[[nodiscard]] Vec3 radiance_exposure(const std::string& path);

}  // namespace isolux
