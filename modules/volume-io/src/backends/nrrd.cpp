#include "../files.h"
#include "../make_volume.h"
#include "../nrrd_header.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/volume_reader.h>

#include <algorithm>

namespace isolux {
namespace {

// Which axes are space: axes of one sample are dropped until three are left, those that the header calls no domain
// first.
std::vector<detail::NrrdAxis> spatial_axes(const detail::NrrdHeader& header) {
  std::vector<detail::NrrdAxis> axes = header.axes;
  const auto drop = [&](auto unwanted) {
    for (auto it = axes.begin(); axes.size() > 3 && it != axes.end();)
      it = it->size == 1 && unwanted(*it) ? axes.erase(it) : it + 1;
  };
  drop([&](const detail::NrrdAxis& axis) { return header.has_directions && !axis.direction; });
  drop(
      [](const detail::NrrdAxis& axis) { return axis.kind != "domain" && axis.kind != "space" && axis.kind != "???"; });
  std::reverse(axes.begin(), axes.end());
  drop([](const detail::NrrdAxis&) { return true; });
  std::reverse(axes.begin(), axes.end());
  if (axes.size() == 3) return axes;
  std::vector<std::string> shown;
  for (const auto& axis : header.axes) shown.push_back(fmt::format("{} ({})", axis.size, axis.kind));
  throw InvalidInput(
      fmt::format("{}: axes of sizes {}: a volume has 3, one number a voxel; further axes may have 1 "
                  "sample only",
                  header.path, fmt::join(shown, ", ")));
}

/// NRRD (Kindlmann, "Definition of NRRD File Format"), attached and detached headers. Immutable, callable from many
/// threads.
class NrrdReader final : public VolumeReader {
 public:
  using Options = NoOptions;
  explicit NrrdReader(const Options& /*options*/) {}

  [[nodiscard]] int claims(const std::string& source, const ReadOptions& /*options*/) const override {
    if (detail::first_bytes(source, 7) == "NRRD000") return 2;
    return detail::has_extension(source, ".nrrd") || detail::has_extension(source, ".nhdr") ? 1 : 0;
  }

  [[nodiscard]] StoredVolume read(const std::string& source, const ReadOptions& options,
                                  const Run& run) const override {
    const detail::NrrdHeader header = detail::read_nrrd_header(source, options);
    const auto axes = spatial_axes(header);
    detail::NrrdFrame frame = detail::nrrd_frame(header, axes);
    return detail::make_volume(source, frame.lattice, detail::read_nrrd_values(header, options, run),
                               header.layout.type, std::move(frame.space), options);
  }

  [[nodiscard]] std::vector<std::string> files(const std::string& source, const ReadOptions& options) const override {
    return {source, detail::read_nrrd_header(source, options).data_file};
  }
};

}  // namespace

namespace backends {
void nrrd(Registry<VolumeReader>& registry) {
  registry.add<NrrdReader>("nrrd", "NRRD, attached (.nrrd) and detached (.nhdr); raw, gzip and text encodings");
}
}  // namespace backends

}  // namespace isolux
