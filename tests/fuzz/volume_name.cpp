// Files told by their names, headerless ones among them. The input's first line is the name, behind a byte that says
// which options go with it; the others are the file.
#include <algorithm>

#include "volume_laws.h"

namespace {

isolux::ReadOptions options_of(unsigned bits) {
  isolux::ReadOptions options;
  options.big_endian = (bits & 1u) != 0;
  if ((bits & 2u) != 0) options.spacing = isolux::Vec3(0.5, 2.0, 4.0);
  if ((bits & 4u) != 0) options.nodata = 7.0;
  if ((bits & 8u) != 0) options.subtract = 1e300;
  if ((bits & 16u) != 0) options.raw = {.size = {3, 2, 2}, .type = isolux::ScalarType((bits >> 5) & 7u)};
  return options;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace isolux::fuzz;
  constexpr std::size_t kLongestName = 200;
  if (size == 0) return 0;
  const std::string text = text_of(data + 1, size - 1);
  std::string name = text.substr(0, std::min(text.find('\n'), kLongestName));
  const std::string bytes = text.substr(std::min(text.size(), name.size() + 1));
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '/' || c == '\0'; }, '_');
  if (name.empty() || name.find_first_not_of('.') == std::string::npos) return 0;
  const std::string path = folder().write(name, bytes);
  check_volume(path, bytes.size(), options_of(data[0]));
  std::filesystem::remove(path);
  return 0;
}
