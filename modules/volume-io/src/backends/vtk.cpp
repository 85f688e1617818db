#include "../files.h"
#include "../legacy_vtk.h"
#include "../make_volume.h"

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
    return detail::make_volume(source, header.lattice, detail::read_legacy_vtk_values(header, options, run),
                               header.data.layout.type, "3D-right-handed", options);
  }
};

}  // namespace

namespace backends {
void vtk(Registry<VolumeReader>& registry) {
  registry.add<VtkReader>("vtk", "legacy VTK image data (.vtk), binary and text");
}
}  // namespace backends

}  // namespace isolux
