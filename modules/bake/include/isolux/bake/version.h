#pragma once

namespace isolux {

/// The version of isolux, as in CHANGELOG.md.
inline constexpr const char* kVersion = "0.1.0";

}  // namespace isolux
