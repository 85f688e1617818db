#include "../files.h"
#include "../make_volume.h"
#include "../raw_name.h"
#include "../scalars.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/volume_reader.h>

#include <array>

namespace isolux {
namespace {

/// Headerless files whose layout the caller or the file's name gives. Immutable, callable from many threads.
class RawReader final : public VolumeReader {
 public:
  using Options = NoOptions;
  explicit RawReader(const Options& /*options*/) {}

  [[nodiscard]] int claims(const std::string& source, const ReadOptions& options) const override {
    if (options.raw) return 3;
    return detail::has_extension(source, ".raw") ? 1 : 0;
  }

  [[nodiscard]] bool takes_layout() const override { return true; }

  [[nodiscard]] StoredVolume read(const std::string& source, const ReadOptions& options,
                                  const Run& run) const override {
    const std::uint64_t found = detail::require_file(source);
    auto layout = options.raw ? options.raw : detail::parse_raw_name(source);
    if (layout && !options.raw) layout->big_endian = options.big_endian;
    if (!layout)
      throw UnknownLayout(
          fmt::format("{}: a headerless file says its size and type in its name, as in "
                      "name_64x64x64_uint8.raw, or is given --dims and --type",
                      source));
    const std::array<std::int64_t, 3> sizes = {layout->size.x, layout->size.y, layout->size.z};
    const std::size_t width = bytes_per_scalar(layout->type);
    const std::uint64_t count = detail::checked_count(source, sizes, width);
    if (found != count * width)
      throw IoError(fmt::format("{}: {}x{}x{} voxels of {} are {} bytes, {} found", source, sizes[0], sizes[1],
                                sizes[2], scalar_type_name(layout->type), count * width, found));
    auto values = detail::decode_scalars(*detail::file_source(source, 0), {layout->type, layout->big_endian}, count,
                                         options, source, run);
    return detail::make_volume(source, {.size = layout->size, .frame = {}}, std::move(values), layout->type,
                               "3D-right-handed", options);
  }
};

}  // namespace

namespace backends {
void raw(Registry<VolumeReader>& registry) {
  registry.add<RawReader>("raw", "headerless: name_WxHxD_type.raw, or with dims, type and endianness given");
}
}  // namespace backends

}  // namespace isolux
