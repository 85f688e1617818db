#include "raw_name.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/scalar_type.h>

#include <charconv>
#include <filesystem>
#include <regex>

namespace isolux::detail {

std::optional<RawLayout> parse_raw_name(const std::string& path) {
  static const std::regex form(R"(.*_(\d{1,10})x(\d{1,10})x(\d{1,10})_(u?int(?:8|16|32|64)|float(?:32|64))\.raw)",
                               std::regex::icase);
  const std::string name = std::filesystem::path(path).filename().string();
  std::smatch parts;
  // The recursive matcher of the standard library needs stack for each character.
  if (name.size() > 255 || !std::regex_match(name, parts, form)) return std::nullopt;
  RawLayout layout;
  for (int a = 0; a < 3; ++a) {
    const std::string digits = parts[std::size_t(a) + 1];
    int size = 0;
    if (std::from_chars(digits.data(), digits.data() + digits.size(), size).ec != std::errc()) return std::nullopt;
    layout.size[a] = size;
  }
  std::string type = parts[4];
  for (char& c : type) c = char(std::tolower(static_cast<unsigned char>(c)));
  layout.type = parse_scalar_type(type);
  return layout;
}

std::string raw_name_end(const RawLayout& layout) {
  return fmt::format("_{}x{}x{}_{}.raw", layout.size.x, layout.size.y, layout.size.z, scalar_type_name(layout.type));
}

}  // namespace isolux::detail
