#include "dicom_walker.h"
#include "files.h"
#include "format_checks.h"
#include "number_text.h"
#include "plain_text.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

namespace isolux::detail {
namespace {

bool has_mark(const std::string& path) {
  const std::string bytes = first_bytes(path, kFirstElement);
  return bytes.size() == kFirstElement && bytes.ends_with("DICM");
}

// What a file says of its one image.
struct DicomImage {
  std::uint64_t rows = 0;
  std::uint64_t columns = 0;
  std::uint64_t bits = 0;
  std::uint64_t samples = 1;
  std::string photometric;
  std::optional<std::string> orientation;
  std::optional<std::string> spacing;
  std::string slope = "1";
  std::uint64_t stored_bits = 0;
  bool is_signed = false;
  bool has_table = false;          ///< of what values stand for, in place of the slope
  bool functional_groups = false;  ///< the enhanced kind, which keeps its frame in there
  bool compressed = false;
};

void take_syntax(const std::string& path, const std::string& syntax, DicomWalker& walker, DicomImage& image) {
  if (syntax == "1.2.840.10008.1.2.2" || syntax == "1.2.840.10008.1.2.1.99")
    throw InvalidInput(
        fmt::format("{}: DICOM transfer syntax {} (big endian or deflated) is not supported", path, syntax));
  image.compressed = syntax != "1.2.840.10008.1.2" && syntax != "1.2.840.10008.1.2.1";
  if (syntax == "1.2.840.10008.1.2") walker.set_implicit();
}

void take(const std::string& path, const Element& e, DicomWalker& walker, DicomImage& image) {
  if (e.tag == 0x00020010u) take_syntax(path, walker.text(e), walker, image);
  if (e.tag == 0x00200037u) image.orientation = walker.text(e);
  if (e.tag == 0x00280002u) image.samples = walker.number(e);
  if (e.tag == 0x00280004u) image.photometric = walker.text(e);
  if (e.tag == 0x00280008u && walker.text(e) != "1" && !walker.text(e).empty())
    throw InvalidInput(fmt::format("{}: DICOM of {} frames: supported is one a file", path, excerpt(walker.text(e))));
  if (e.tag == 0x00280010u) image.rows = walker.number(e);
  if (e.tag == 0x00280011u) image.columns = walker.number(e);
  if (e.tag == 0x00280030u) image.spacing = walker.text(e);
  if (e.tag == 0x00280100u) image.bits = walker.number(e);
  if (e.tag == 0x00280101u) image.stored_bits = walker.number(e);
  if (e.tag == 0x00280103u) image.is_signed = walker.number(e) != 0;
  if (e.tag == 0x00283000u) image.has_table = walker.has_items(e);
  if (e.tag == 0x00281053u) image.slope = walker.text(e);
  if (e.tag == 0x52009229u || e.tag == 0x52009230u) image.functional_groups = true;
}

// Numbers with backslashes between; NaN for what is none.
std::vector<double> decimals(std::string text) {
  std::replace(text.begin(), text.end(), '\\', ' ');
  std::vector<double> numbers;
  for (const auto& word : plain_words(text))
    numbers.push_back(parse_real(word).value_or(std::numeric_limits<double>::quiet_NaN()));
  return numbers;
}

// GDCM takes other numbers for 1.
void check_spacing(const std::string& path, const DicomImage& image) {
  if (!image.spacing && image.functional_groups) return;
  if (!image.spacing)
    throw InvalidInput(
        fmt::format("{}: DICOM without PixelSpacing does not say how far voxels are apart: give --spacing", path));
  const auto spacing = decimals(*image.spacing);
  if (spacing.size() != 2 || !std::all_of(spacing.begin(), spacing.end(), [](double s) { return s > 0.0; }))
    throw InvalidInput(fmt::format("{}: PixelSpacing {}: two numbers above 0 are needed, or --spacing", path,
                                   excerpt(*image.spacing)));
}

// GDCM puts the world's axes in the place of directions that are not at right angles, to this sine.
void check_orientation(const std::string& path, const std::string& text) {
  constexpr double kMostTilt = 1e-3;
  const auto n = decimals(text);
  const bool six = n.size() == 6;
  const Vec3 row = six ? Vec3(n[0], n[1], n[2]) : Vec3(0);
  const Vec3 column = six ? Vec3(n[3], n[4], n[5]) : Vec3(0);
  // False also for directions that are 0 or no numbers.
  if (!(std::fabs(glm::dot(row, column)) < kMostTilt * glm::length(row) * glm::length(column)))
    throw InvalidInput(
        fmt::format("{}: ImageOrientationPatient {}: two directions at right angles are needed", path, excerpt(text)));
}

void check_bits(const std::string& path, const DicomImage& image) {
  if (image.bits % 8 != 0 || image.bits == 0 || image.bits > 32)
    throw InvalidInput(fmt::format("{}: {} bits a pixel: supported are 8, 16 and 32", path, image.bits));
  // GDCM's assertions end the program.
  const bool has_spare_bits = image.stored_bits != 0 && image.stored_bits != image.bits;
  if (has_spare_bits && image.bits != 16 && !image.compressed)
    throw InvalidInput(fmt::format(
        "{}: pixels of {} bits of which {} are stored: GDCM, which reads them, wants 8 of 8, 32 of 32, or any "
        "of 16",
        path, image.bits, image.stored_bits));
  if (image.photometric != "MONOCHROME1") return;
  // GDCM's assertion once more, and zeros in the place of pixels.
  if (image.bits > 16 || (image.is_signed && image.bits == 16 && image.stored_bits == 12))
    throw InvalidInput(
        fmt::format("{}: MONOCHROME1 of pixels of {} bits of which {} are stored, {} a sign: GDCM, which reads them, "
                    "cannot invert them; save them as MONOCHROME2",
                    path, image.bits, image.stored_bits, image.is_signed ? "with" : "without"));
}

void check_image(const std::string& path, const DicomImage& image, const ReadOptions& options) {
  if (image.samples != 1)
    throw InvalidInput(fmt::format("{}: {} samples a pixel: a volume has one", path, image.samples));
  if (image.photometric != "MONOCHROME1" && image.photometric != "MONOCHROME2")
    throw InvalidInput(fmt::format("{}: PhotometricInterpretation '{}': supported are MONOCHROME1 and MONOCHROME2",
                                   path, excerpt(image.photometric)));
  check_bits(path, image);
  if (image.has_table)
    throw InvalidInput(
        fmt::format("{}: a ModalityLUTSequence, by which its values stand for others, is not supported", path));
  if (decimals(image.slope) == std::vector<double>{0.0})
    throw InvalidInput(fmt::format("{}: RescaleSlope 0: a number other than 0 is needed", path));
  if (!options.spacing) check_spacing(path, image);
  if (image.orientation) check_orientation(path, *image.orientation);
}

void check_pixels(const std::string& path, const Element& e, const DicomImage& image, DicomWalker& walker) {
  const std::array<std::int64_t, 2> size = {std::int64_t(image.columns), std::int64_t(image.rows)};
  const std::uint64_t needed = checked_count(path, size, 8) * (image.bits / 8);
  if (image.compressed) {
    walker.skip(e);
    return;
  }
  const std::uint64_t found = std::min<std::uint64_t>(e.length, walker.bytes_behind(e));
  if (found < needed) throw IoError(fmt::format("{}: {} bytes of pixel data expected, {} found", path, needed, found));
  // GDCM makes room for what the length says, and looks for it for long.
  if (e.length > walker.bytes_behind(e))
    throw IoError(fmt::format("{}: pixel data of {} bytes, the file has {} behind their head", path, e.length, found));
  walker.skip(e);
}

}  // namespace

bool is_dicom(const std::string& path) {
  // A DICOMDIR is a table of contents, not an image.
  return has_mark(path) && std::filesystem::path(path).filename() != "DICOMDIR";
}

CheckedHeader check_dicom(const std::string& path, const ReadOptions& options) {
  DicomWalker walker(path);
  if (!has_mark(path)) throw InvalidInput(fmt::format("{}: no DICOM file: the mark DICM at byte 128 is missing", path));
  DicomImage image;
  while (!walker.at_end()) {
    const Element e = walker.next();
    // GDCM loses its place there, and takes any bytes behind for lengths.
    if (!e.known && e.tag >> 16 == 2)
      throw InvalidInput(fmt::format("{}: a DICOM file's head with an element of the kind '{}', which there is not",
                                     path, excerpt(e.kind)));
    take(path, e, walker, image);
    if (e.tag == kPixelData) {
      check_image(path, image, options);
      check_pixels(path, e, image, walker);
      walker.check_rest();
      return {.size = {int(image.columns), int(image.rows), 1}, .type = {}, .data = {}};
    }
    walker.go_to(e.value);
    walker.skip(e);
  }
  throw InvalidInput(fmt::format("{}: a DICOM file without pixel data", path));
}

}  // namespace isolux::detail
