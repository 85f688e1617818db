#include "tiff_description.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <charconv>

namespace isolux::detail {
namespace {

// How many of each a program says that there are.
struct Hyperstack {
  std::string_view program;
  std::uint64_t channels = 1;
  std::uint64_t sections = 1;
  std::uint64_t frames = 1;
};

// The number behind a key that stands behind one of `before`, such as in "key=1" and 'key="1"'; 1 if there is none.
std::uint64_t number_of(std::string_view text, std::string_view key, std::string_view before) {
  std::uint64_t number = 1;
  for (std::size_t at = text.find(key); at != std::string_view::npos; at = text.find(key, at + 1)) {
    if (at == 0 || before.find(text[at - 1]) == std::string_view::npos) continue;
    const std::size_t digits = std::min(text.find_first_not_of(" \t\r\n=\"'", at + key.size()), text.size());
    (void)std::from_chars(text.data() + digits, text.data() + text.size(), number);
    break;
  }
  return number;
}
std::uint64_t of_line(std::string_view text, std::string_view key) { return number_of(text, key, "\n"); }
std::uint64_t of_attribute(std::string_view tag, std::string_view key) { return number_of(tag, key, " \t\r\n"); }

// Where an XML element of this name begins, with or without a prefix such as "ome:".
std::size_t find_tag(std::string_view text, std::string_view name, std::size_t from = 0) {
  for (std::size_t at = text.find('<', from); at != std::string_view::npos; at = text.find('<', at + 1)) {
    const std::string_view rest = text.substr(at + 1);
    if (rest.starts_with("!--")) {
      at = std::min(text.find("-->", at), text.size() - 1);
      continue;
    }
    const std::string_view found = rest.substr(0, rest.find_first_of(" \t\r\n/><"));
    if (found.substr(found.find(':') + 1) == name) return at;  // all of it without a colon, npos + 1 being 0
  }
  return std::string_view::npos;
}

// Pages of several axes lie in an order that a volume has not. Those of one may be sections by a wrong name: the
// program tifffile calls them channels unless it is told.
std::string check_axes(const std::string& path, const Hyperstack& stack) {
  const auto& [program, channels, sections, frames] = stack;
  if (channels <= 1 && frames <= 1) return {};
  if ((channels > 1 ? 1 : 0) + (sections > 1 ? 1 : 0) + (frames > 1 ? 1 : 0) > 1)
    throw InvalidInput(fmt::format(
        "{}: {} says channels: {}, sections: {}, frames: {}: a volume is the sections of one channel in one "
        "frame; save these alone (in ImageJ: Image, Duplicate)",
        path, program, channels, sections, frames));
  return fmt::format("{}: {} says that its pages are {}: they are taken as sections", path, program,
                     channels > 1 ? "channels" : "frames");
}

std::string check_imagej(const std::string& path, std::string_view text, std::uint64_t pages) {
  if (const std::uint64_t images = of_line(text, "images"); images > pages)
    throw InvalidInput(fmt::format(
        "{}: ImageJ says images={}, of which {} have TIFF pages, as it writes them above 4 GB: save them as "
        "raw data or as a sequence of files",
        path, images, pages));
  return check_axes(path, {.program = "ImageJ",
                           .channels = of_line(text, "channels"),
                           .sections = of_line(text, "slices"),
                           .frames = of_line(text, "frames")});
}

std::string check_ome(const std::string& path, std::string_view text, std::uint64_t pages) {
  constexpr std::string_view kPixels = "Pixels";
  const std::size_t begin = find_tag(text, kPixels);
  if (begin == std::string_view::npos) return {};
  const std::string_view tag = text.substr(begin, text.find('>', begin) - begin);
  const Hyperstack stack{.program = "OME",
                         .channels = of_attribute(tag, "SizeC"),
                         .sections = of_attribute(tag, "SizeZ"),
                         .frames = of_attribute(tag, "SizeT")};
  std::string remark = check_axes(path, stack);
  if (pages > stack.channels * stack.sections * stack.frames &&
      find_tag(text, kPixels, begin + 1) != std::string_view::npos)
    throw InvalidInput(
        fmt::format("{}: OME says several images, the first of {} sections: save one alone", path, stack.sections));
  return remark;
}

}  // namespace

std::string check_description(const std::string& path, std::string_view description, std::uint64_t pages) {
  if (description.starts_with("ImageJ=")) return check_imagej(path, description, pages);
  return find_tag(description, "OME") == std::string_view::npos ? "" : check_ome(path, description, pages);
}

}  // namespace isolux::detail
