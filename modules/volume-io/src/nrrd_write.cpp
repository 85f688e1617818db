#include "nrrd_write.h"

#include "gzip_writer.h"
#include "nrrd_space.h"
#include "nrrd_text.h"
#include "scalars.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <cmath>

namespace isolux::detail {
namespace {

// NRRD's own names of the floating types; the others are called as ours are.
std::string_view type_name(ScalarType type) {
  if (type == ScalarType::kFloat32) return "float";
  if (type == ScalarType::kFloat64) return "double";
  return scalar_type_name(type);
}

// The shortest text that reads back as the same double.
std::string vector_text(const Vec3& v) { return fmt::format("({},{},{})", v.x + 0.0, v.y + 0.0, v.z + 0.0); }

std::string space_text(const std::string& space) {
  const auto known = nrrd_space(space);
  return known ? fmt::format("space: {}\n", known->name) : "space dimension: 3\n";
}

std::string pair_text(const std::string& key, const std::string& value) {
  if (key.empty() || key.front() == '#' || key.find_first_of(":\n\r\\") != std::string::npos)
    throw InvalidInput(fmt::format(
        "'{}' cannot be a key of a NRRD file: allowed is text without colons, backslashes and line ends", key));
  return fmt::format("{}:={}\n", key, escape_nrrd_value(value));
}

}  // namespace

void write_nrrd_header(std::ostream& out, const NrrdImage& image) {
  const Lattice& lattice = image.lattice;
  const bool vector = image.channels > 1;
  std::string text = "NRRD0005\n# The format is defined at http://teem.sourceforge.net/nrrd/format.html\n";
  text += fmt::format("type: {}\ndimension: {}\n", type_name(image.type), vector ? 4 : 3);
  text += fmt::format("sizes: {}{} {} {}\n", vector ? fmt::format("{} ", image.channels) : "", lattice.size.x,
                      lattice.size.y, lattice.size.z);
  text += space_text(image.space);
  text += fmt::format("space directions: {}{} {} {}\n", vector ? "none " : "", vector_text(lattice.frame.axes[0]),
                      vector_text(lattice.frame.axes[1]), vector_text(lattice.frame.axes[2]));
  text += fmt::format("kinds: {}domain domain domain\n", vector ? "vector " : "");
  text += fmt::format("endian: little\nencoding: {}\n", image.compress ? "gzip" : "raw");
  text += fmt::format("space origin: {}\n", vector_text(lattice.frame.origin));
  if (!image.data_file.empty()) text += fmt::format("data file: {}\n", image.data_file);
  for (const auto& [key, value] : image.key_values) text += pair_text(key, value);
  if (image.data_file.empty()) text += "\n";
  out.write(text.data(), std::streamsize(text.size()));
}

void write_nrrd_values(std::ostream& out, const NrrdImage& image, const VolumeView::Voxels& values) {
  if (image.compress) {
    GzipWriter gzip(out);
    encode_scalars(values, image.type, [&](std::span<const std::byte> bytes) { gzip.write(bytes); });
    gzip.finish();
  } else {
    encode_scalars(values, image.type, [&](std::span<const std::byte> bytes) {
      out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    });
  }
}

}  // namespace isolux::detail
