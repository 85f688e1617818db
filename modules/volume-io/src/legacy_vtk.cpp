#include "legacy_vtk.h"

#include "files.h"
#include "format_checks.h"
#include "number_text.h"
#include "plain_text.h"
#include "vtk_extent.h"
#include "vtk_lines.h"
#include "vtk_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <array>
#include <optional>

namespace isolux::detail {
namespace {

constexpr std::string_view kMagic = "# vtk DataFile Version";
constexpr std::uint64_t kMostValues = std::uint64_t(1) << 48;

using Words = std::vector<std::string>;

/// Follows a file from array to array.
class Walk {
 public:
  explicit Walk(const std::string& path) : lines_(path) { file_.file = path; }

  LegacyVtk follow() {
    start();
    try {
      for (Words words = lines_.words(); !words.empty(); words = lines_.words()) part(words);
    } catch (const Error& error) {
      const bool some =
          std::any_of(file_.arrays.begin(), file_.arrays.end(), [](const auto& a) { return a.info.plain; });
      if (!some) throw;
      file_.remark = fmt::format("{}; it is read no further", error.what());
    }
    return place();
  }

 private:
  void start();
  LegacyVtk place();
  void part(const Words& words);
  bool geometry(const std::string& key, const Words& words);
  void attribute(const VtkAttribute& attribute, const Words& words);
  void field(const Words& words);
  void metadata();
  void pass(const std::string& name, const std::string& type, std::uint64_t components, std::uint64_t tuples);
  [[nodiscard]] bool pass_strings(std::uint64_t count);
  void add(VtkArrayInfo info, const std::string& type, std::uint64_t components, std::uint64_t tuples, bool colours);

  [[nodiscard]] InvalidInput wrong(const Words& words, std::string_view why) const {
    return InvalidInput(
        fmt::format("{}: VTK '{}': {}", file_.file, excerpt(fmt::format("{}", fmt::join(words, " "))), why));
  }
  [[nodiscard]] std::array<double, 3> triple(const Words& words) const;
  [[nodiscard]] std::uint64_t whole(const Words& words, std::size_t index) const;

  VtkLines lines_;
  LegacyVtk file_;
  std::vector<std::uint64_t> tuples_;  ///< of the arrays
  std::optional<std::array<std::int64_t, 3>> sizes_;
  std::array<double, 3> spacing_ = {1, 1, 1};
  std::array<double, 3> origin_ = {0, 0, 0};
  std::optional<bool> of_cells_;  ///< what attributes are now of
  std::uint64_t count_ = 0;       ///< how many of these there are, as the file says
  std::uint64_t components_ = 0;  ///< of the array before
};

std::array<double, 3> Walk::triple(const Words& words) const {
  if (words.size() != 4) throw wrong(words, "three numbers are needed");
  std::array<double, 3> numbers{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = parse_real(words[i + 1]);
    if (!value) throw wrong(words, fmt::format("'{}' is not a number", excerpt(words[i + 1])));
    numbers.at(i) = *value;
  }
  return numbers;
}

std::uint64_t Walk::whole(const Words& words, std::size_t index) const {
  if (index >= words.size() || !reads_as(ScalarType::kInt64, words[index]) || words[index].front() == '-')
    throw wrong(words, fmt::format("a whole number is needed as word {}", index + 1));
  return std::uint64_t(std::stoull(words[index]));
}

void Walk::start() {
  if (!is_legacy_vtk(file_.file))
    throw InvalidInput(fmt::format("{}: no legacy VTK file: '{}' is missing", file_.file, kMagic));
  (void)lines_.line();
  (void)lines_.line();  // the title, which may be empty
  const auto needed = [&] {
    Words words = lines_.words();
    if (words.empty()) throw IoError(fmt::format("{}: the VTK header ends early", file_.file));
    return words;
  };
  const std::string encoding = needed().front();
  file_.text = lower_case(encoding) == "ascii";
  if (!file_.text && lower_case(encoding) != "binary")
    throw InvalidInput(
        fmt::format("{}: VTK encoding '{}': allowed are BINARY and ASCII", file_.file, excerpt(encoding)));
  const Words words = needed();
  if (words.size() != 2 || lower_case(words[0]) != "dataset" || lower_case(words[1]) != "structured_points")
    throw wrong(words, "supported is DATASET STRUCTURED_POINTS");
}

void Walk::part(const Words& words) {
  const std::string key = lower_case(words.front());
  if (geometry(key, words)) return;
  if (key == "metadata") return metadata();
  if (key == "field") return field(words);
  if (key == "lookup_table") return pass(vtk_decoded(words.back()), "unsigned_char", 4, whole(words, 2));
  const VtkAttribute* const found = find_vtk_attribute(key);
  if (found == nullptr) throw wrong(words, "this is no part of DATASET STRUCTURED_POINTS");
  attribute(*found, words);
}

bool Walk::geometry(const std::string& key, const Words& words) {
  if (key == "dimensions") {
    (void)triple(words);
    if (!std::all_of(words.begin() + 1, words.end(), [](const auto& w) { return reads_as(ScalarType::kInt64, w); }))
      throw wrong(words, "three whole numbers are needed");
    sizes_ = {std::stoll(words[1]), std::stoll(words[2]), std::stoll(words[3])};
  } else if (key == "spacing" || key == "aspect_ratio") {
    const auto spacing = triple(words);
    require_spacing(file_.file, spacing);
    spacing_ = spacing;
  } else if (key == "origin") {
    const auto origin = triple(words);
    require_finite(file_.file, "the origin", origin);
    origin_ = origin;
  } else if (key == "point_data" || key == "cell_data") {
    of_cells_ = key == "cell_data";
    count_ = whole(words, 1);
  } else {
    return false;
  }
  return true;
}

void Walk::attribute(const VtkAttribute& attribute, const Words& words) {
  if (!of_cells_) throw wrong(words, "it stands without POINT_DATA or CELL_DATA before it");
  const bool scalars = attribute.role == VtkRole::kScalars && attribute.type_word != 0;
  const std::size_t last = std::max(attribute.type_word, attribute.component_word);
  if (words.size() > last + 1 || words.size() < (scalars ? last : last + 1))
    throw wrong(words,
                scalars ? "SCALARS have a name, a type and at most a number of components" : "words are missing");
  const std::uint64_t components = attribute.component_word > 0 && attribute.component_word < words.size()
                                       ? whole(words, attribute.component_word)
                                       : attribute.components;
  if (scalars) {
    const Words table = lines_.words();
    if (table.empty() || lower_case(table.front()) != "lookup_table")
      throw wrong(words, "SCALARS have a LOOKUP_TABLE line behind theirs");
  }
  const VtkArrayInfo info{.name = vtk_decoded(words[1]), .of_cells = *of_cells_, .role = attribute.role};
  const bool colours = attribute.type_word == 0;
  add(info, colours ? "unsigned_char" : words[attribute.type_word], components, count_, colours);
}

// NAME NUMBER, and so many arrays of any length, each with a line "NAME COMPONENTS TUPLES TYPE" before it.
void Walk::field(const Words& words) {
  const std::uint64_t arrays = whole(words, 2);
  for (std::uint64_t i = 0; i < arrays; ++i) {
    Words line = lines_.words();
    if (line.size() == 1 && lower_case(line.front()) == "metadata") {
      metadata();
      line = lines_.words();
    }
    if (line.empty())
      throw IoError(fmt::format("{}: VTK: {} arrays of a FIELD expected, {} found", file_.file, arrays, i));
    if (line.size() == 1 && lower_case(line.front()) == "null_array") continue;
    if (line.size() != 4) throw wrong(line, "an array of a FIELD has a name, components, tuples and a type");
    const std::uint64_t components = whole(line, 1);
    const std::uint64_t tuples = whole(line, 2);
    const VtkArrayInfo info{.name = vtk_decoded(line[0]), .of_cells = of_cells_.value_or(false)};
    if (of_cells_)
      add(info, line[3], components, tuples, false);
    else
      pass(info.name, line[3], components, tuples);
  }
}

void Walk::add(VtkArrayInfo info, const std::string& type, std::uint64_t components, std::uint64_t tuples,
               bool colours) {
  const auto known = vtk_scalar_type(type);
  if (components != 1) info.peculiarity += fmt::format(" ({} components)", components);
  if (!known) info.peculiarity += fmt::format(" (type '{}')", excerpt(type));
  info.plain = components == 1 && known;
  const std::string name = info.name;
  file_.arrays.push_back({std::move(info), known.value_or(ScalarType::kUint8), lines_.offset(), colours});
  tuples_.push_back(tuples);
  pass(name, type, components, tuples);
}

// What VTK notes of the array before: lines up to an empty one. Names of components may be empty lines.
void Walk::metadata() {
  for (auto line = lines_.line(); line; line = lines_.line()) {
    const Words words = plain_words(*line);
    if (words.empty()) return;
    if (lower_case(words.front()) != "component_names") continue;
    for (std::uint64_t i = 0; i < components_ && line; ++i) line = lines_.line();
  }
}

void Walk::pass(const std::string& name, const std::string& type, std::uint64_t components, std::uint64_t tuples) {
  components_ = components;
  if (components > 0 && tuples > kMostValues / components)
    throw InvalidInput(fmt::format("{}: VTK array '{}': {} components of {} are more values than a file holds",
                                   file_.file, excerpt(name), components, tuples));
  const std::uint64_t values = components * tuples;
  const auto known = vtk_scalar_type(type);
  const std::string kind = lower_case(type);
  bool passed = false;
  if (kind == "string" || kind == "utf8_string") {
    passed = pass_strings(values);
  } else if (file_.text) {
    passed = lines_.skip_words(values);
  } else if (known || kind == "bit") {
    passed = lines_.skip_bytes(known ? values * bytes_per_scalar(*known) : (values + 7) / 8);
  } else {
    throw InvalidInput(fmt::format("{}: VTK array '{}': of type '{}', whose size is unknown", file_.file, excerpt(name),
                                   excerpt(type)));
  }
  if (!passed) throw IoError(fmt::format("{}: the file ends within the VTK array '{}'", file_.file, excerpt(name)));
}

// As text a line each; else behind their length, whose first two bits tell how many bytes it has.
bool Walk::pass_strings(std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i) {
    if (file_.text) {
      if (!lines_.line()) return false;
      continue;
    }
    const auto first = lines_.byte();
    if (!first) return false;
    std::uint64_t length = *first & 0x3Fu;
    for (unsigned more = (1u << (3u - (*first >> 6u))) - 1; more > 0; --more) {
      const auto next = lines_.byte();
      if (!next) return false;
      length = (length << 8u) | *next;
    }
    if (!lines_.skip_bytes(length)) return false;
  }
  return true;
}

LegacyVtk Walk::place() {
  if (!sizes_) throw InvalidInput(fmt::format("{}: VTK has no DIMENSIONS", file_.file));
  (void)checked_count(file_.file, *sizes_, 8);
  const VtkExtent points{{}, {(*sizes_)[0] - 1, (*sizes_)[1] - 1, (*sizes_)[2] - 1}};
  constexpr std::array<double, 9> kUpright = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  file_.points = detail::lattice_of(points, points, origin_, spacing_, kUpright);
  file_.cells = detail::lattice_of(points, cells_of(points), origin_, spacing_, kUpright);
  for (std::size_t i = 0; i < file_.arrays.size(); ++i) {
    LegacyVtkArray& array = file_.arrays[i];
    const std::uint64_t count = file_.lattice_of(array).count();
    if (tuples_[i] == count) continue;
    array.info.plain = false;
    array.info.peculiarity += fmt::format(" ({} of them, DIMENSIONS make {})", tuples_[i], count);
  }
  return std::move(file_);
}

}  // namespace

bool is_legacy_vtk(const std::string& path) { return first_bytes(path, kMagic.size()) == kMagic; }

LegacyVtk read_legacy_vtk(const std::string& path) {
  (void)require_file(path);
  return Walk(path).follow();
}

}  // namespace isolux::detail
