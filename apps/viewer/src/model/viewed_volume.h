#pragma once

#include <isolux/core/volume.h>

#include <mutex>
#include <optional>

namespace isolux::viewer {

/// A volume that is looked at: in its file's type, and in floats too from when its light asks for them. Callable from
/// many threads.
class ViewedVolume {
 public:
  explicit ViewedVolume(StoredVolume volume);
  explicit ViewedVolume(Volume volume) : ViewedVolume(keep_floats(std::move(volume))) {}

  [[nodiscard]] VolumeView stored() const { return narrow_ ? VolumeView(*narrow_) : VolumeView(floats_); }
  [[nodiscard]] const Lattice& lattice() const { return stored().lattice(); }
  [[nodiscard]] const std::string& name() const { return stored().name(); }
  /// Made by the first call.
  [[nodiscard]] const Volume& floats() const;

 private:
  std::optional<StoredVolume> narrow_;  ///< none where the file holds wider numbers
  mutable std::once_flag once_;
  mutable Volume floats_;
};

}  // namespace isolux::viewer
