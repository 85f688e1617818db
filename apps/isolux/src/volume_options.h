#pragma once

#include <isolux/core/volume.h>
#include <isolux/volume_io/volume_reader.h>

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "session.h"

namespace isolux {

/// The VOLUME argument and what goes with it.
class VolumeOptions {
 public:
  void add_to(CLI::App& command, Session& session);
  [[nodiscard]] const std::string& source() const { return source_; }
  /// As in the file and in its type, with --subtract, --nodata and --replace-nonfinite applied: else voxels may be
  /// infinite or not numbers; axes may be 1 wide. Warns of what reading lost. \throw UsageError, IoError, InvalidInput
  [[nodiscard]] StoredVolume read_as_is(Session& session) const;
  /// The same, fit for surfaces (require_usable).
  [[nodiscard]] StoredVolume read_stored(Session& session) const;
  /// In floats, fit for every stage.
  [[nodiscard]] Volume read(Session& session) const;

 private:
  [[nodiscard]] ReadOptions read_options(const Session& session) const;
  [[nodiscard]] StoredVolume read_in(VoxelForm form, Session& session) const;
  void warn_of_no_effect(const ReadOptions& options, const Session& session) const;

  std::string source_;
  std::string dims_;
  std::string type_;
  std::string spacing_;
  std::string endian_;
  std::string replacement_;
  std::string nodata_;
  std::string subtract_;
  std::vector<std::string> set_;
  bool allow_external_ = false;
};

}  // namespace isolux
