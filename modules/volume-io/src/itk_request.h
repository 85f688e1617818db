#pragma once

#include "sent_volume.h"

#include <optional>
#include <string>
#include <vector>

namespace isolux::detail {

enum class ItkFormat : std::uint8_t { kMetaImage, kTiff, kDicom };

/// What the shared library of src/loaded/itk is to read and send.
struct ItkRequest {
  ItkFormat format = ItkFormat::kMetaImage;
  std::string source;              ///< as the user named it
  std::vector<std::string> files;  ///< slices or pages; of other formats the one file
  Index3 size{0};                  ///< by our own look at the headers
  std::optional<double> gap;       ///< between DICOM slices, if the user says, world units
};

/// What that library is asked by, under the name kItkEntry. \throw InvalidInput, IoError naming the file
using ItkEntry = void(const ItkRequest& request, const SendBytes& send);
constexpr const char* kItkEntry = "isolux_itk_send";

}  // namespace isolux::detail
