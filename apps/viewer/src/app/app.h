#pragma once

#include <isolux/volume_io/volume_reader.h>

#include <string>

#include "app/viewer.h"

namespace isolux::viewer {

/// What the program does besides looking.
struct AppSettings {
  ViewerSettings viewer;
  int width = 1200;
  int height = 800;
  int frames = 0;          ///< leave after so many pictures of the finished surface; 0: when the user does
  std::string screenshot;  ///< the surface without slider and text, written before leaving; "" for none
};

/// Opens the window on the document and stays until it is closed; the isovalue that it showed last. \throw GlError,
/// IoError, InvalidInput
[[nodiscard]] float run_app(Document document, const AppSettings& settings, const Stages& stages);

}  // namespace isolux::viewer
