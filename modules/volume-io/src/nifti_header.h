#pragma once

#include "data_place.h"

#include <isolux/core/lattice.h>

#include <string>

namespace isolux::detail {

/// A NIfTI header of version 1 or 2, understood and checked.
struct NiftiHeader {
  Lattice lattice;  ///< LPS, millimetres
  DataPlace data;
  std::string remark;  ///< where sform and qform contradict each other; else empty
};

/// Tells NIfTI by its content, also the header of a .hdr/.img pair, which is not read.
[[nodiscard]] bool is_nifti(const std::string& path);

/// `frame` is FrameOptions::frame. The world is the sform's where its code says scanner coordinates or there is no
/// qform, else the qform's, as ITK and so 3D Slicer choose; without either the axes are the world's. \throw IoError,
/// InvalidInput naming the file, the value and what is allowed; also where the file cannot hold the data promised
[[nodiscard]] NiftiHeader read_nifti_header(const std::string& path, int frame);

}  // namespace isolux::detail
