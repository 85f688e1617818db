#include "../files.h"
#include "../make_volume.h"
#include "../nifti_header.h"

#include <isolux/volume_io/volume_reader.h>

namespace isolux {
namespace {

/// NIfTI (Cox et al., "The NIfTI-1 data format", 2004; NIfTI-2, 2011), single files. Immutable, callable from many
/// threads.
class NiftiReader final : public VolumeReader {
 public:
  using Options = detail::FrameOptions;
  explicit NiftiReader(const Options& options) : frame_(options.frame) {}

  [[nodiscard]] int claims(const std::string& source, const ReadOptions& /*options*/) const override {
    if (detail::is_nifti(source)) return 2;
    const bool named = detail::has_extension(source, ".nii") || detail::has_extension(source, ".nii.gz");
    return named && !detail::is_directory(source) ? 1 : 0;
  }

  [[nodiscard]] StoredVolume read(const std::string& source, const ReadOptions& options,
                                  const Run& run) const override {
    const detail::NiftiHeader header = detail::read_nifti_header(source, frame_);
    auto values = detail::read_values(header.data, header.lattice.count(), options, run);
    StoredVolume volume = detail::make_volume(source, header.lattice, std::move(values),
                                              detail::voxel_type(header.data), "left-posterior-superior", options);
    if (!header.remark.empty()) volume.remarks.push_back(header.remark);
    return volume;
  }

 private:
  int frame_;
};

}  // namespace

namespace backends {
void nifti(Registry<VolumeReader>& registry) {
  registry.add<NiftiReader>("nifti", "NIfTI of versions 1 and 2 (.nii, .nii.gz), intensity scaling applied");
}
}  // namespace backends

}  // namespace isolux
