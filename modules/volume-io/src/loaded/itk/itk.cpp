#include "../../itk_request.h"
#include "slice_stack.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>
#include <itkGDCMImageIO.h>
#include <itkMetaImageIO.h>
#include <itkMultiThreaderBase.h>
#include <itkTIFFImageIO.h>

#include <algorithm>
#include <regex>
#include <set>

namespace isolux::detail {
namespace {

template <class T>
void send_value(const SendBytes& send, const T& value) {
  send(std::as_bytes(std::span(&value, 1)));
}

void send_block(const SendBytes& send, ScalarType type, std::span<const std::byte> values) {
  send_value(send, SentBlock{type, values.size()});
  send(values);
}

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

// ITK's own words, without what it says first: its name, and an object's address, which is another one each time.
std::string words_of(const itk::ExceptionObject& problem) {
  static const std::regex prefix(R"(^(ITK ERROR: )?(\w+\(0x[0-9a-f]+\): )?)");
  std::string words = std::regex_replace(problem.GetDescription(), prefix, "");
  std::replace(words.begin(), words.end(), '\n', ' ');
  return words;
}

template <class Io>
typename Io::Pointer open(const std::string& file) {
  const auto io = Io::New();
  io->SetFileName(file);
  try {
    io->ReadImageInformation();
  } catch (const itk::ExceptionObject& problem) {
    throw IoError(fmt::format("{}: ITK cannot read it: {}", file, words_of(problem)));
  }
  if (io->GetNumberOfComponents() != 1)
    throw InvalidInput(fmt::format("{}: {} numbers a voxel: a volume has one", file, io->GetNumberOfComponents()));
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
    throw IoError(fmt::format("{}: ITK cannot read it: {}", path, words_of(problem)));
  }
  send_block(send, scalar_type(path, io), pixels);
}

// The parent reads the values itself.
void send_lattice(const std::string& file, const SendBytes& send) {
  const auto io = open<itk::MetaImageIO>(file);
  send_value(send, SentVolume{.lattice = lattice_of(file, *io), .stored_type = scalar_type(file, *io), .blocks = 0});
}

std::vector<Slice> dicom_slices(const std::string& source, const std::vector<std::string>& files) {
  std::vector<Slice> slices;
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
  const SliceStack stack = stack_slices(source, slices, gap);
  const bool one_type =
      std::all_of(slices.begin(), slices.end(), [&](const Slice& s) { return s.type == slices[0].type; });
  send_value(send, SentVolume{.lattice = stack.lattice,
                              .stored_type = one_type ? slices.front().type : ScalarType::kFloat32,
                              .blocks = slices.size(),
                              .remark_bytes = stack.remark.size()});
  if (!stack.remark.empty()) send(std::as_bytes(std::span(stack.remark)));
  for (const auto& slice : slices) send_pixels(slice.path, *open<itk::GDCMImageIO>(slice.path), send);
}

void send_tiffs(const std::vector<std::string>& files, Index3 size, const SendBytes& send) {
  const ScalarType first = scalar_type(files.front(), *open<itk::TIFFImageIO>(files.front()));
  send_value(send, SentVolume{.lattice = {.size = size, .frame = {}}, .stored_type = first, .blocks = files.size()});
  for (const auto& file : files) send_pixels(file, *open<itk::TIFFImageIO>(file), send);
}

}  // namespace

extern "C" void isolux_itk_send(const ItkRequest& request, const SendBytes& send) {
  itk::MultiThreaderBase::SetGlobalDefaultNumberOfThreads(1);
  switch (request.format) {
    case ItkFormat::kMetaImage:
      return send_lattice(request.source, send);
    case ItkFormat::kTiff:
      return send_tiffs(request.files, request.size, send);
    case ItkFormat::kDicom:
      return send_dicom(request.source, request.files, request.gap, send);
  }
}

}  // namespace isolux::detail
