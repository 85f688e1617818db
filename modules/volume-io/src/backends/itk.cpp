#include "../child_process.h"
#include "../files.h"
#include "../format_checks.h"
#include "../itk_request.h"
#include "../make_volume.h"
#include "../received_volume.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/volume_reader.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iterator>

namespace isolux {
namespace {

using detail::ItkEntry;
using detail::ItkFormat;
using detail::SendBytes;
constexpr std::string_view kAnatomical = "left-posterior-superior";
constexpr std::string_view kPlain = "3D-right-handed";

/// What to read, by our own look at it.
struct Plan {
  detail::ItkRequest request;
  detail::CheckedHeader checked;
  std::string_view space;
  std::vector<std::string> remarks{};
};

Plan tiff_plan(const std::string& source, const std::vector<std::string>& files, const ReadOptions& options) {
  if (!options.spacing)
    throw InvalidInput(fmt::format("{}: TIFF does not say how far voxels are apart: give --spacing", source));
  const detail::CheckedHeader first = detail::check_tiff(files.front());
  detail::CheckedHeader all = first;
  for (std::size_t i = 1; i < files.size(); ++i) {
    const detail::CheckedHeader page = detail::check_tiff(files[i]);
    if (page.size != first.size || page.size.z != 1 || page.type != first.type)
      throw InvalidInput(fmt::format("{}: {} has {}x{} {} pixels on {} pages, {} has {}x{} {} on {}", source, files[i],
                                     page.size.x, page.size.y, scalar_type_name(*page.type), page.size.z, files.front(),
                                     first.size.x, first.size.y, scalar_type_name(*first.type), first.size.z));
    ++all.size.z;
  }
  return {{.format = ItkFormat::kTiff, .source = source, .files = files, .size = all.size, .gap = {}},
          all,
          kPlain,
          {all.remark, detail::missing_page(source, files)}};
}

Plan dicom_plan(const std::string& source, const std::vector<std::string>& files, const ReadOptions& options) {
  detail::CheckedHeader checked;
  for (const auto& file : files) checked = detail::check_dicom(file, options);
  checked.size.z = int(files.size());
  std::optional<double> gap;
  if (options.spacing) gap = options.spacing->z;
  return {{.format = ItkFormat::kDicom, .source = source, .files = files, .size = checked.size, .gap = gap},
          checked,
          kAnatomical};
}

Plan folder_plan(const std::string& source, const ReadOptions& options) {
  if (const auto slices = detail::files_in_folder(source, detail::is_dicom); !slices.empty())
    return dicom_plan(source, slices, options);
  const auto pages = detail::files_in_folder(source, detail::is_tiff);
  if (pages.empty()) throw InvalidInput(fmt::format("{}: a folder without DICOM slices or TIFF pages", source));
  return tiff_plan(source, pages, options);
}

struct Known {
  ItkFormat format;
  bool (*is)(const std::string&);
  std::array<std::string_view, 2> extensions;
};
constexpr std::array<Known, 3> kKnown = {{{ItkFormat::kDicom, detail::is_dicom, {".dcm", ".dcm"}},
                                          {ItkFormat::kTiff, detail::is_tiff, {".tif", ".tiff"}},
                                          {ItkFormat::kMetaImage, detail::is_meta_image, {".mha", ".mhd"}}}};

const Known* known_by_content(const std::string& source) {
  const auto* const found = std::find_if(kKnown.begin(), kKnown.end(), [&](const Known& k) { return k.is(source); });
  return found == kKnown.end() ? nullptr : found;
}

const Known* known_by_name(const std::string& source) {
  for (const Known& known : kKnown)
    for (const std::string_view extension : known.extensions)
      if (detail::has_extension(source, extension)) return &known;
  return nullptr;
}

Plan plan(const std::string& source, const ReadOptions& options) {
  if (detail::is_directory(source)) return folder_plan(source, options);
  (void)detail::require_file(source);
  const Known* known = known_by_content(source);
  if (known == nullptr) known = known_by_name(source);
  if (known == nullptr)
    throw InvalidInput(fmt::format("{}: none of the formats read with ITK: MetaImage, TIFF, DICOM", source));
  switch (known->format) {
    case ItkFormat::kDicom:
      return dicom_plan(source, {source}, options);
    case ItkFormat::kTiff:
      return tiff_plan(source, {source}, options);
    case ItkFormat::kMetaImage:
      break;
  }
  detail::CheckedHeader checked = detail::check_meta_image(source, options);
  return {{.format = known->format, .source = source, .files = {source}, .size = checked.size, .gap = {}},
          std::move(checked),
          kAnatomical};
}

/// In the child. ITK's libraries take 25 ms and 20 MB to be there, so that only who reads with them loads them. The
/// library is found by the program's RUNPATH, which whoever links this module has from it.
ItkEntry* load_itk(const std::string& source) {
  void* library = dlopen(ISOLUX_ITK_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  void* entry = library == nullptr ? nullptr : dlsym(library, detail::kItkEntry);
  if (entry == nullptr)
    throw IoError(fmt::format("{}: the library that reads it cannot be loaded: {}", source, dlerror()));
  return reinterpret_cast<ItkEntry*>(entry);
}

/// MetaImage, TIFF and DICOM through ITK, in a child process and behind our own checks. Immutable,
/// callable from many threads.
class ItkReader final : public VolumeReader {
 public:
  struct Options {
    double time_limit = 300.0;
    void describe(OptionVisitor& option) {
      option("time_limit", time_limit,
             {.min = 1.0, .max = 86400.0, .unit = "s", .help = "gives up a file that takes longer"});
    }
  };
  explicit ItkReader(const Options& options) : options_(options) {}

  [[nodiscard]] int claims(const std::string& source, const ReadOptions& /*options*/) const override {
    if (detail::is_directory(source)) {
      const bool known = !detail::files_in_folder(source, detail::is_dicom).empty() ||
                         !detail::files_in_folder(source, detail::is_tiff).empty();
      return known ? 2 : 1;
    }
    if (known_by_content(source) != nullptr) return 2;
    return known_by_name(source) != nullptr ? 1 : 0;
  }

  [[nodiscard]] StoredVolume read(const std::string& source, const ReadOptions& options,
                                  const Run& run) const override {
    const Plan what = plan(source, options);
    const auto limit = std::chrono::seconds(std::int64_t(std::ceil(options_.time_limit)));
    detail::ReceivedVolume volume;
    detail::run_in_child(
        source, limit, run, [&](const SendBytes& send) { load_itk(source)(what.request, send); },
        [&](detail::ByteSource& received) {
          volume = detail::receive_volume(received, source, what.checked, options, run);
        });
    if (what.checked.data) {
      volume.values = detail::read_values(*what.checked.data, volume.header.lattice.count(), options, run);
      volume.header.stored_type = detail::voxel_type(*what.checked.data);
    }
    StoredVolume result = detail::make_volume(source, volume.header.lattice, std::move(volume.values),
                                              volume.header.stored_type, std::string(what.space), options);
    std::vector<std::string> remarks = what.remarks;
    remarks.push_back(volume.remark);
    std::copy_if(remarks.begin(), remarks.end(), std::back_inserter(result.remarks),
                 [](const std::string& remark) { return !remark.empty(); });
    return result;
  }

  [[nodiscard]] std::vector<std::string> files(const std::string& source, const ReadOptions& options) const override {
    if (detail::is_directory(source)) {
      auto slices = detail::files_in_folder(source, detail::is_dicom);
      return slices.empty() ? detail::files_in_folder(source, detail::is_tiff) : slices;
    }
    if (detail::is_meta_image(source)) return {source, detail::meta_image_data_file(source, options)};
    return {source};
  }

 private:
  Options options_;
};

}  // namespace

namespace backends {
void itk(Registry<VolumeReader>& registry) {
  registry.add<ItkReader>("itk", "MetaImage, TIFF stacks and DICOM series, in a child process");
}
}  // namespace backends

}  // namespace isolux
