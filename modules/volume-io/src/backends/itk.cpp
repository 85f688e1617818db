#include "../files.h"
#include "../format_checks.h"
#include "../itk_pixels.h"
#include "../make_volume.h"
#include "../slice_stack.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/volume_reader.h>
#include <itkGDCMImageIO.h>
#include <itkMetaImageIO.h>
#include <itkMultiThreaderBase.h>
#include <itkNiftiImageIO.h>
#include <itkTIFFImageIO.h>
#include <itkVTKImageIO.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <set>

namespace isolux {
namespace {

using detail::SendBytes;
constexpr std::string_view kAnatomical = "left-posterior-superior";
constexpr std::string_view kPlain = "3D-right-handed";

// ---- in the child process ----

ScalarType scalar_type(const std::string& path, const itk::ImageIOBase& io) {
  const auto bytes = io.GetComponentSize();
  using Kind = itk::IOComponentEnum;
  const auto by_size = [&](ScalarType one, ScalarType two, ScalarType four, ScalarType eight) {
    return bytes == 1 ? one : bytes == 2 ? two : bytes == 4 ? four : eight;
  };
  switch (io.GetComponentType()) {
    case Kind::UCHAR:
    case Kind::USHORT:
    case Kind::UINT:
    case Kind::ULONG:
    case Kind::ULONGLONG:
      return by_size(ScalarType::kUint8, ScalarType::kUint16, ScalarType::kUint32, ScalarType::kUint64);
    case Kind::CHAR:
    case Kind::SHORT:
    case Kind::INT:
    case Kind::LONG:
    case Kind::LONGLONG:
      return by_size(ScalarType::kInt8, ScalarType::kInt16, ScalarType::kInt32, ScalarType::kInt64);
    case Kind::FLOAT:
      return ScalarType::kFloat32;
    case Kind::DOUBLE:
      return ScalarType::kFloat64;
    default:
      throw InvalidInput(fmt::format("{}: ITK does not know the type of its voxels", path));
  }
}

template <class Io>
typename Io::Pointer open(const std::string& path) {
  const auto io = Io::New();
  io->SetFileName(path);
  try {
    io->ReadImageInformation();
  } catch (const itk::ExceptionObject& problem) {
    throw IoError(fmt::format("{}: ITK cannot read it: {}", path, problem.GetDescription()));
  }
  if (io->GetNumberOfComponents() != 1)
    throw InvalidInput(fmt::format("{}: {} numbers a voxel: a volume has one", path, io->GetNumberOfComponents()));
  return io;
}

Lattice lattice_of(const std::string& path, const itk::ImageIOBase& io) {
  Lattice lattice;
  lattice.size = Index3(1);
  for (unsigned a = 0; a < io.GetNumberOfDimensions(); ++a) {
    const auto size = io.GetDimensions(a);
    if (a >= 3) {
      if (size > 1)
        throw InvalidInput(fmt::format("{}: {} samples on axis {}: a volume has 3 axes", path, size, a + 1));
      continue;
    }
    lattice.size[int(a)] = int(size);
    const auto direction = io.GetDirection(a);
    Vec3& axis = lattice.frame.axes[int(a)];
    for (unsigned c = 0; c < 3; ++c)
      axis[int(c)] = (c < direction.size() ? direction[c] : (a == c ? 1.0 : 0.0)) * io.GetSpacing(a);
    lattice.frame.origin[int(a)] = io.GetOrigin(a);
  }
  return lattice;
}

void send_pixels(const std::string& path, itk::ImageIOBase& io, const SendBytes& send) {
  itk::ImageIORegion region(io.GetNumberOfDimensions());
  for (unsigned a = 0; a < io.GetNumberOfDimensions(); ++a) region.SetSize(a, io.GetDimensions(a));
  io.SetIORegion(region);
  std::vector<std::byte> pixels(std::size_t(io.GetImageSizeInBytes()));
  try {
    io.Read(pixels.data());
  } catch (const itk::ExceptionObject& problem) {
    throw IoError(fmt::format("{}: ITK cannot read it: {}", path, problem.GetDescription()));
  }
  detail::send_block(send, scalar_type(path, io), pixels);
}

template <class Io>
void send_file(const std::string& path, const SendBytes& send) {
  const auto io = open<Io>(path);
  detail::send_volume(send, {.lattice = lattice_of(path, *io), .stored_type = scalar_type(path, *io), .blocks = 1});
  send_pixels(path, *io, send);
}

std::vector<detail::Slice> dicom_slices(const std::string& source, const std::vector<std::string>& files) {
  std::vector<detail::Slice> slices;
  std::set<std::string> series;
  for (const auto& file : files) {
    const auto io = open<itk::GDCMImageIO>(file);
    std::string id;
    io->GetValueFromTag("0020|000e", id);
    series.insert(id.c_str());
    slices.push_back({.path = file, .lattice = lattice_of(file, *io), .type = scalar_type(file, *io)});
  }
  if (series.size() > 1)
    throw InvalidInput(fmt::format("{}: {} DICOM series in one folder ({}): keep one in it", source, series.size(),
                                   fmt::join(series, ", ")));
  return slices;
}

void send_dicom(const std::string& source, const std::vector<std::string>& files, std::optional<double> gap,
                const SendBytes& send) {
  auto slices = dicom_slices(source, files);
  const Lattice lattice = detail::stack_slices(source, slices, gap);
  const bool one_type =
      std::all_of(slices.begin(), slices.end(), [&](const detail::Slice& s) { return s.type == slices[0].type; });
  detail::send_volume(send, {.lattice = lattice,
                             .stored_type = one_type ? slices.front().type : ScalarType::kFloat32,
                             .blocks = slices.size()});
  for (const auto& slice : slices) send_pixels(slice.path, *open<itk::GDCMImageIO>(slice.path), send);
}

void send_tiffs(const std::vector<std::string>& files, Index3 size, const SendBytes& send) {
  const ScalarType first = scalar_type(files.front(), *open<itk::TIFFImageIO>(files.front()));
  detail::send_volume(send, {.lattice = {.size = size, .frame = {}}, .stored_type = first, .blocks = files.size()});
  for (const auto& file : files) send_pixels(file, *open<itk::TIFFImageIO>(file), send);
}

// ---- in the program ----

/// What to read, by our own look at it, and the work that a child does to read it.
struct Plan {
  Index3 size{0};
  std::string_view space;
  std::function<void(const SendBytes&)> work;
};

Plan tiff_plan(const std::string& source, const std::vector<std::string>& files, const ReadOptions& options) {
  if (!options.spacing)
    throw InvalidInput(fmt::format("{}: TIFF does not say how far voxels are apart: give --spacing", source));
  const Index3 first = detail::check_tiff(files.front()).size;
  Index3 size = first;
  for (std::size_t i = 1; i < files.size(); ++i) {
    const Index3 page = detail::check_tiff(files[i]).size;
    if (page != first || page.z != 1)
      throw InvalidInput(fmt::format("{}: {} has {}x{} pixels on {} pages, {} has {}x{} on {}", source, files[i],
                                     page.x, page.y, page.z, files.front(), first.x, first.y, first.z));
    ++size.z;
  }
  return {
      .size = size, .space = kPlain, .work = [files, size](const SendBytes& send) { send_tiffs(files, size, send); }};
}

Plan dicom_plan(const std::string& source, const std::vector<std::string>& files, const ReadOptions& options) {
  Index3 size(0);
  for (const auto& file : files) size = detail::check_dicom(file).size;
  size.z = int(files.size());
  std::optional<double> gap;
  if (options.spacing) gap = options.spacing->z;
  return {.size = size, .space = kAnatomical, .work = [source, files, gap](const SendBytes& send) {
            send_dicom(source, files, gap, send);
          }};
}

Plan folder_plan(const std::string& source, const ReadOptions& options) {
  if (const auto slices = detail::files_in_folder(source, detail::is_dicom); !slices.empty())
    return dicom_plan(source, slices, options);
  const auto pages = detail::files_in_folder(source, detail::is_tiff);
  if (pages.empty()) throw InvalidInput(fmt::format("{}: a folder without DICOM slices or TIFF pages", source));
  return tiff_plan(source, pages, options);
}

Plan plan(const std::string& source, const ReadOptions& options) {
  if (detail::is_directory(source)) return folder_plan(source, options);
  (void)detail::require_file(source);
  if (detail::is_dicom(source)) return dicom_plan(source, {source}, options);
  if (detail::is_tiff(source)) return tiff_plan(source, {source}, options);
  if (detail::is_legacy_vtk(source))
    return {.size = detail::check_legacy_vtk(source).size, .space = kPlain, .work = [source](const SendBytes& send) {
              send_file<itk::VTKImageIO>(source, send);
            }};
  if (detail::is_meta_image(source))
    return {.size = detail::check_meta_image(source, options).size,
            .space = kAnatomical,
            .work = [source](const SendBytes& send) { send_file<itk::MetaImageIO>(source, send); }};
  return {.size = detail::check_nifti(source).size, .space = kAnatomical, .work = [source](const SendBytes& send) {
            send_file<itk::NiftiImageIO>(source, send);
          }};
}

/// NIfTI, MetaImage, legacy VTK, TIFF and DICOM through ITK, in a child process and behind our own checks. Immutable,
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
    if (detail::is_dicom(source) || detail::is_tiff(source) || detail::is_legacy_vtk(source) ||
        detail::is_meta_image(source) || detail::is_nifti(source))
      return 2;
    for (const auto* extension : {".nii", ".nii.gz", ".mha", ".mhd", ".vtk", ".tif", ".tiff", ".dcm"}) {
      if (detail::has_extension(source, extension)) return 1;
    }
    return 0;
  }

  [[nodiscard]] StoredVolume read(const std::string& source, const ReadOptions& options,
                                  const Run& run) const override {
    const Plan what = plan(source, options);
    const auto limit = std::chrono::seconds(std::int64_t(std::ceil(options_.time_limit)));
    detail::ReceivedVolume volume;
    detail::run_in_child(
        source, limit, run,
        [&](const SendBytes& send) {
          itk::MultiThreaderBase::SetGlobalDefaultNumberOfThreads(1);
          what.work(send);
        },
        [&](detail::ByteSource& received) {
          volume = detail::receive_volume(received, source, what.size, options.form, run);
        });
    return detail::make_volume(source, volume.header.lattice, std::move(volume.values), volume.header.stored_type,
                               std::string(what.space), options);
  }

 private:
  Options options_;
};

}  // namespace

namespace backends {
void itk(Registry<VolumeReader>& registry) {
  registry.add<ItkReader>("itk", "NIfTI, MetaImage, legacy VTK, TIFF stacks and DICOM series, in a child process");
}
}  // namespace backends

}  // namespace isolux
