#include "nrrd_space.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace isolux::detail {
namespace {

struct KnownSpace {
  std::string_view full;
  std::string_view shorter;
  NrrdSpace meaning;
};

constexpr std::string_view kLps = "left-posterior-superior";
const std::array<KnownSpace, 6> kSpaces = {{
    {"left-posterior-superior", "lps", {kLps, Vec3(1.0, 1.0, 1.0)}},
    {"right-anterior-superior", "ras", {kLps, Vec3(-1.0, -1.0, 1.0)}},
    {"left-anterior-superior", "las", {kLps, Vec3(1.0, -1.0, 1.0)}},
    {"scanner-xyz", "scanner-xyz", {"scanner-xyz", Vec3(1.0)}},
    {"3d-right-handed", "3dr", {"3D-right-handed", Vec3(1.0)}},
    {"3d-left-handed", "3dl", {"3D-left-handed", Vec3(1.0)}},
}};

}  // namespace

std::optional<NrrdSpace> nrrd_space(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  for (const auto& space : kSpaces) {
    if (lower == space.full || lower == space.shorter) return space.meaning;
  }
  return std::nullopt;
}

}  // namespace isolux::detail
