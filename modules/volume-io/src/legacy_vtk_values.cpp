#include "legacy_vtk.h"

#include "files.h"
#include "plain_text.h"
#include "text_values.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <cmath>

namespace isolux::detail {
namespace {

// The bytes that fractions of 255 stand for, rounded as VTK does.
class Fractions final : public ByteSource {
 public:
  Fractions(NumberText& text, const std::string& path, std::uint64_t count) : text_(text), path_(path), count_(count) {}

  std::size_t read(std::span<std::byte> into) override {
    for (std::byte& byte : into) {
      const std::string& word = text_.next();
      if (word.empty()) throw IoError(fmt::format("{}: {} numbers of data expected, {} found", path_, count_, done_));
      const auto value = parse_real(word);
      if (!value || !(*value >= 0.0 && *value <= 1.0))
        throw InvalidInput(fmt::format("{}: '{}', value {} of the data, is no number from 0 to 1 as COLOR_SCALARS are",
                                       path_, excerpt(word), done_));
      byte = std::byte(std::lround(255.0 * *value));
      ++done_;
    }
    return into.size();
  }

 private:
  NumberText& text_;
  std::string path_;
  std::uint64_t count_;
  std::uint64_t done_ = 0;
};

void require_no_number_behind(const std::string& path, std::uint64_t offset, std::uint64_t count) {
  NumberText behind(path, offset, kTextBlanks);
  const std::string word = [&]() -> std::string {
    try {
      return behind.next();
    } catch (const IoError&) {
      return {};  // a word of any length may be there, as long as it is no number
    }
  }();
  if (parse_real(word))
    throw IoError(fmt::format("{}: {} numbers of data expected, more found: '{}'", path, count, excerpt(word)));
}

}  // namespace

DecodedValues read_legacy_vtk_values(const LegacyVtk& file, const LegacyVtkArray& array, const ReadOptions& options,
                                     const Run& run) {
  const DataPlace place{.file = file.file, .offset = array.offset, .more_allowed = true, .layout = {array.type, true}};
  const std::uint64_t count = file.lattice_of(array).count();
  if (!file.text) return read_values(place, count, options, run);
  if (const std::uint64_t size = require_file(file.file); count > size)
    throw IoError(fmt::format("{}: {} numbers of data expected in {} bytes", file.file, count, size));
  NumberText text(file.file, array.offset, kTextBlanks);
  DecodedValues values;
  if (array.colours) {
    Fractions bytes(text, file.file, count);
    values = decode_scalars(bytes, place.layout, count, options, file.file, run);
  } else {
    values = read_text_values(text, array.type, count, options, file.file, run);
  }
  require_no_number_behind(file.file, text.offset(), count);
  return values;
}

}  // namespace isolux::detail
