#include "../files.h"
#include "../legacy_vtk.h"
#include "../make_volume.h"

#include <fmt/format.h>
#include <isolux/volume_io/volume_reader.h>

namespace isolux {
namespace {

/// Legacy VTK image data ("VTK File Formats", VTK User's Guide). Immutable, callable from many threads.
class VtkReader final : public VolumeReader {
 public:
  using Options = NoOptions;
  explicit VtkReader(const Options& /*options*/) {}

  [[nodiscard]] int claims(const std::string& source, const ReadOptions& /*options*/) const override {
    if (detail::is_legacy_vtk(source)) return 2;
    return detail::has_extension(source, ".vtk") ? 1 : 0;
  }

  [[nodiscard]] StoredVolume read(const std::string& source, const ReadOptions& options,
                                  const Run& run) const override {
    const detail::LegacyVtk header = detail::read_legacy_vtk_header(source);
    detail::VtkValues read = detail::read_legacy_vtk_values(header, options, run);
    StoredVolume volume = detail::make_volume(source, header.lattice, std::move(read.values), header.data.layout.type,
                                              "3D-right-handed", options);
    if (!read.left_out.empty())
      volume.remarks.push_back(fmt::format("{}: its first SCALARS, '{}', are read; {} and what follows is left out",
                                           source, header.name, read.left_out));
    return volume;
  }
};

}  // namespace

namespace backends {
void vtk(Registry<VolumeReader>& registry) {
  registry.add<VtkReader>("vtk", "legacy VTK image data (.vtk), binary and text");
}
}  // namespace backends

}  // namespace isolux
