#include "../files.h"
#include "../legacy_vtk.h"
#include "../make_volume.h"

#include <isolux/volume_io/volume_reader.h>

#include <string>
#include <utility>
#include <vector>

namespace isolux {
namespace {

/// Legacy VTK image data ("VTK File Formats", VTK User's Guide). Immutable, callable from many threads.
class VtkReader final : public VolumeReader {
 public:
  struct Options {
    std::string array;
    void describe(OptionVisitor& option) {
      option("array", array, {.help = "name of the array to read; else the first SCALARS or the first that will do"});
    }
  };
  explicit VtkReader(Options options) : options_(std::move(options)) {}

  [[nodiscard]] int claims(const std::string& source, const ReadOptions& /*options*/) const override {
    if (detail::is_legacy_vtk(source)) return 2;
    return detail::has_extension(source, ".vtk") ? 1 : 0;
  }

  [[nodiscard]] StoredVolume read(const std::string& source, const ReadOptions& options,
                                  const Run& run) const override {
    const detail::LegacyVtk file = detail::read_legacy_vtk(source);
    std::vector<detail::VtkArrayInfo> infos;
    for (const detail::LegacyVtkArray& array : file.arrays) infos.push_back(array.info);
    const detail::VtkChoice choice = detail::choose_vtk_array(source, infos, options_.array);
    const detail::LegacyVtkArray& array = file.arrays[choice.array];
    StoredVolume volume =
        detail::make_volume(source, file.lattice_of(array), detail::read_legacy_vtk_values(file, array, options, run),
                            array.type, "3D-right-handed", options);
    if (std::string remark = detail::remark_on_choice(source, "vtk", array.info, choice);
        options_.array.empty() && !remark.empty())
      volume.remarks.push_back(std::move(remark));
    if (!file.remark.empty()) volume.remarks.push_back(file.remark);
    return volume;
  }

 private:
  Options options_;
};

}  // namespace

namespace backends {
void vtk(Registry<VolumeReader>& registry) {
  registry.add<VtkReader>("vtk", "legacy VTK image data (.vtk), binary and text");
}
}  // namespace backends

}  // namespace isolux
