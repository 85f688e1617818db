#pragma once

#include <isolux/volume_io/light_file.h>

#include <CLI/App.hpp>
#include <string>

#include "session.h"

namespace isolux {

/// --light LIGHT.nrrd and --force.
class LightOptions {
 public:
  void add_to(CLI::App& command);
  [[nodiscard]] bool given() const { return !path_.empty(); }
  /// Reads the light and refuses that of another volume unless --force. \throw IoError, InvalidInput
  [[nodiscard]] LightFile read(const Volume& volume, Session& session) const;

 private:
  std::string path_;
  bool force_ = false;
};

}  // namespace isolux
