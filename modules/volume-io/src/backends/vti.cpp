#include "../files.h"
#include "../format_checks.h"
#include "../make_volume.h"
#include "../plain_text.h"
#include "../vtk_choice.h"
#include "../vtk_extent.h"
#include "../vtk_xml_array.h"
#include "../vtk_xml_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/volume_reader.h>

#include <algorithm>
#include <array>
#include <optional>
#include <pugixml.hpp>

namespace isolux {
namespace {

constexpr const char* kSections[] = {"PointData", "CellData"};

std::string shown(const pugi::xml_node& node, const char* attribute) {
  return detail::excerpt(node.attribute(attribute).value());
}

std::string attribute(const std::string& path, const pugi::xml_node& node, const char* name) {
  if (!node.attribute(name)) throw InvalidInput(fmt::format("{}: VTK XML: {} has no '{}'", path, node.name(), name));
  return node.attribute(name).value();
}

template <std::size_t N>
std::array<double, N> numbers(const std::string& path, const pugi::xml_node& node, const char* name,
                              std::array<double, N> otherwise) {
  if (!node.attribute(name)) return otherwise;
  detail::parse_numbers(path, name, node.attribute(name).value(), otherwise);
  detail::require_finite(path, name, otherwise);
  return otherwise;
}

detail::VtkExtent extent(const std::string& path, const pugi::xml_node& node, const char* name) {
  return detail::parse_extent(path, name, attribute(path, node, name));
}

/// An array of a piece, by the element that it is in and its name.
struct ArrayName {
  const char* section = nullptr;
  std::string name;
  [[nodiscard]] bool of_cells() const { return section == kSections[1]; }
};

/// One number a voxel.
bool is_plain(const pugi::xml_node& node) {
  const auto components = node.attribute("NumberOfComponents");
  return (!components || components.value() == std::string("1")) &&
         detail::vtk_xml_type(node.attribute("type").value());
}

/// What a message adds to an array's name.
std::string peculiarity(const pugi::xml_node& node) {
  std::string text;
  if (const auto components = node.attribute("NumberOfComponents");
      components && components.as_string() != std::string("1"))
    text += fmt::format(" ({} components)", shown(node, "NumberOfComponents"));
  if (!detail::vtk_xml_type(node.attribute("type").value())) text += fmt::format(" (type '{}')", shown(node, "type"));
  return text;
}

std::vector<detail::VtkArrayInfo> arrays_of(const pugi::xml_node& piece) {
  std::vector<detail::VtkArrayInfo> arrays;
  for (const char* section : kSections) {
    const pugi::xml_node data = piece.child(section);
    const std::string active = data.attribute("Scalars").value();
    const std::string ids[] = {data.attribute("GlobalIds").value(), data.attribute("PedigreeIds").value()};
    for (const pugi::xml_node& node : data.children("DataArray")) {
      const std::string name = node.attribute("Name").value();
      const bool of_ids = !name.empty() && (name == ids[0] || name == ids[1]);
      arrays.push_back({.name = name,
                        .of_cells = section == kSections[1],
                        .role = name == active ? detail::VtkRole::kScalars
                                : of_ids       ? detail::VtkRole::kIds
                                               : detail::VtkRole::kOther,
                        .plain = is_plain(node),
                        .peculiarity = peculiarity(node)});
    }
  }
  return arrays;
}

/// The file's XML and what holds for all of its arrays.
class VtiFile {
 public:
  explicit VtiFile(const std::string& path) : path_(path), xml_(detail::read_vtk_xml_text(path)) {
    // In place and without another encoding, so that places in the text are places in the file.
    const auto parsed =
        document_.load_buffer_inplace(xml_.text.data(), xml_.text.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!parsed)
      throw InvalidInput(
          fmt::format("{}: no well-formed XML: {} at byte {}", path, parsed.description(), parsed.offset));
    root_ = document_.child("VTKFile");
    if (const std::string type = attribute(path, root_, "type"); type != "ImageData")
      throw InvalidInput(
          fmt::format("{}: VTK XML of type '{}': supported is ImageData (.vti)", path, detail::excerpt(type)));
    const std::string version = root_.attribute("version").as_string("0.1");
    if (version.size() < 2 || version[0] < '0' || version[0] > '2' || version[1] != '.')
      throw InvalidInput(
          fmt::format("{}: VTK XML of version '{}': supported are 0.1 to 2.2", path, detail::excerpt(version)));
    image_ = root_.child("ImageData");
    if (!image_) throw InvalidInput(fmt::format("{}: VTK XML: VTKFile has no 'ImageData'", path));
    if (!image_.child("Piece")) throw InvalidInput(fmt::format("{}: VTK XML: ImageData has no 'Piece'", path));
  }

  [[nodiscard]] const pugi::xml_node& image() const { return image_; }

  [[nodiscard]] detail::VtkXmlArray array(const pugi::xml_node& node) const {
    detail::VtkXmlArray array;
    array.file = path_;
    const auto type = detail::vtk_xml_type(attribute(path_, node, "type"));
    if (!type) throw InvalidInput(fmt::format("{}: VTK XML: DataArray of type '{}'", path_, shown(node, "type")));
    array.layout.type = *type;
    const std::string format = one_of(node, "format", {"ascii", "binary", "appended"});
    if (format == "ascii") {
      array.offset = text_begin(node);
      return array;
    }
    array.format = detail::VtkXmlFormat::kBase64;
    array.alone = format == "binary";
    array.layout.big_endian = one_of(root_, "byte_order", {"LittleEndian", "BigEndian"}) == "BigEndian";
    array.wide_header =
        root_.attribute("header_type") && one_of(root_, "header_type", {"UInt32", "UInt64"}) == "UInt64";
    if (root_.attribute("compressor") && !shown(root_, "compressor").empty()) {
      (void)one_of(root_, "compressor", {"vtkZLibDataCompressor"});
      array.compressed = true;
    }
    if (array.alone) {
      array.offset = text_begin(node);
      return array;
    }
    const std::string offset = attribute(path_, node, "offset");
    if (!detail::reads_as(ScalarType::kInt64, offset) || node.attribute("offset").as_llong() < 0)
      throw InvalidInput(
          fmt::format("{}: VTK XML: offset '{}': a whole number is needed", path_, detail::excerpt(offset)));
    if (xml_.appended == 0) throw InvalidInput(fmt::format("{}: VTK XML: there are no AppendedData", path_));
    if (node.attribute("offset").as_ullong() > detail::require_file(path_))
      throw IoError(fmt::format("{}: VTK XML: offset {} lies behind the file's end", path_, offset));
    array.offset = xml_.appended + node.attribute("offset").as_ullong();
    if (one_of(root_.child("AppendedData"), "encoding", {"raw", "base64"}) == "raw")
      array.format = detail::VtkXmlFormat::kRaw;
    return array;
  }

 private:
  [[nodiscard]] std::string one_of(const pugi::xml_node& node, const char* name,
                                   const std::vector<std::string>& allowed) const {
    const std::string value = attribute(path_, node, name);
    if (std::find(allowed.begin(), allowed.end(), value) == allowed.end())
      throw InvalidInput(fmt::format("{}: VTK XML: {} '{}': supported {} {}", path_, name, detail::excerpt(value),
                                     allowed.size() > 1 ? "are" : "is", fmt::join(allowed, ", ")));
    return value;
  }
  [[nodiscard]] std::uint64_t text_begin(const pugi::xml_node& node) const {
    const pugi::xml_node text = node.first_child();
    if (text.type() != pugi::node_pcdata)
      throw IoError(fmt::format("{}: VTK XML: DataArray '{}' has no data", path_, shown(node, "Name")));
    return std::uint64_t(text.offset_debug());
  }

  std::string path_;
  detail::VtkXmlText xml_;
  pugi::xml_document document_;
  pugi::xml_node root_;
  pugi::xml_node image_;
};

Lattice lattice_of_image(const std::string& path, const pugi::xml_node& image, const detail::VtkExtent& points,
                         const detail::VtkExtent& voxels) {
  const auto origin = numbers<3>(path, image, "Origin", {0, 0, 0});
  const auto spacing = numbers<3>(path, image, "Spacing", {1, 1, 1});
  const auto direction = numbers<9>(path, image, "Direction", {1, 0, 0, 0, 1, 0, 0, 0, 1});
  detail::require_spacing(path, spacing);
  return detail::lattice_of(points, voxels, origin, spacing, direction);
}

/// A piece and its values.
struct VtiPiece {
  detail::VtkExtent voxels;
  std::uint64_t count = 0;
  detail::VtkXmlArray array;
};

std::vector<VtiPiece> pieces_of(const std::string& path, const VtiFile& file, const ArrayName& name,
                                const detail::VtkExtent& whole) {
  std::vector<VtiPiece> pieces;
  for (const pugi::xml_node& node : file.image().children("Piece")) {
    detail::VtkExtent voxels = extent(path, node, "Extent");
    if (name.of_cells()) voxels = detail::cells_of(voxels);
    if (!whole.holds(voxels))
      throw InvalidInput(
          fmt::format("{}: VTK XML: Extent '{}' of a Piece lies beyond the WholeExtent", path, shown(node, "Extent")));
    const pugi::xml_node data =
        node.child(name.section).find_child_by_attribute("DataArray", "Name", name.name.c_str());
    if (!data || !is_plain(data))
      throw InvalidInput(fmt::format("{}: VTK XML: a Piece lacks the array '{}'", path, detail::excerpt(name.name)));
    auto array = file.array(data);
    const std::uint64_t count = detail::checked_count(path, voxels.sizes(), bytes_per_scalar(array.layout.type));
    if (!pieces.empty() && array.layout.type != pieces[0].array.layout.type)
      throw InvalidInput(fmt::format("{}: VTK XML: '{}' has several types", path, detail::excerpt(name.name)));
    pieces.push_back({voxels, count, std::move(array)});
  }
  return pieces;
}

/// Image data of VTK XML ("VTK File Formats", VTK User's Guide). Immutable, callable from many threads.
class VtiReader final : public VolumeReader {
 public:
  struct Options {
    std::string array;
    void describe(OptionVisitor& option) {
      option("array", array, {.help = "name of the array to read; else the active scalars or the first that will do"});
    }
  };
  explicit VtiReader(Options options) : options_(std::move(options)) {}

  [[nodiscard]] int claims(const std::string& source, const ReadOptions& /*options*/) const override {
    if (detail::is_vtk_xml(source)) return 2;
    return detail::has_extension(source, ".vti") && !detail::is_directory(source) ? 1 : 0;
  }

  [[nodiscard]] StoredVolume read(const std::string& source, const ReadOptions& options,
                                  const Run& run) const override {
    std::optional<VtiFile> file(std::in_place, source);
    const auto arrays = arrays_of(file->image().child("Piece"));
    const detail::VtkChoice choice = detail::choose_vtk_array(source, arrays, options_.array);
    const detail::VtkArrayInfo& array = arrays[choice.array];
    const detail::VtkExtent points = extent(source, file->image(), "WholeExtent");
    const detail::VtkExtent voxels = array.of_cells ? detail::cells_of(points) : points;
    const auto pieces = pieces_of(source, *file, {kSections[array.of_cells ? 1 : 0], array.name}, voxels);
    const ScalarType type = pieces[0].array.layout.type;
    const std::uint64_t count = detail::checked_count(source, voxels.sizes(), bytes_per_scalar(type));
    const Lattice lattice = lattice_of_image(source, file->image(), points, voxels);
    file.reset();  // its text may be as large as the values
    auto values = read_pieces(source, pieces, voxels, count, options, run);
    auto volume = detail::make_volume(source, lattice, std::move(values), type, "3D-right-handed", options);
    if (std::string remark = detail::remark_on_choice(source, "vti", array, choice);
        options_.array.empty() && !remark.empty())
      volume.remarks.push_back(std::move(remark));
    return volume;
  }

 private:
  static detail::DecodedValues read_pieces(const std::string& source, const std::vector<VtiPiece>& pieces,
                                           const detail::VtkExtent& whole, std::uint64_t count,
                                           const ReadOptions& options, const Run& run) {
    if (pieces.size() == 1 && pieces[0].voxels == whole)
      return detail::read_vtk_xml_array(pieces[0].array, count, options, run);
    std::uint64_t all = 0;
    for (const VtiPiece& piece : pieces) detail::require_room(pieces[0].array, all += piece.count);
    detail::require_covered(source, all, count);
    detail::VtkPieces parts(whole, count);
    for (const VtiPiece& piece : pieces)
      parts.put(piece.voxels, detail::read_vtk_xml_array(piece.array, piece.count, options, run));
    return parts.take(source);
  }

  Options options_;
};

}  // namespace

namespace backends {
void vti(Registry<VolumeReader>& registry) {
  registry.add<VtiReader>("vti", "VTK XML image data (.vti): text, base64 and appended, zlib or not");
}
}  // namespace backends

}  // namespace isolux
