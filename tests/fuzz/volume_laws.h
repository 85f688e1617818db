// What holds of every file that is read as a volume.
#pragma once

#include <isolux/volume_io.h>

#include <optional>

#include "fuzz.h"
#include "support.h"

namespace isolux::fuzz {

/// Where the targets' files lie.
inline const test::TemporaryFolder& folder() {
  static const test::TemporaryFolder there;
  return there;
}

/// That it can be written, and is the same then.
inline void check_copy(const StoredVolume& volume) {
  const std::string copy = folder().file("copy.nrrd");
  if (refused([&] { write_volume(volume, copy); })) return;
  std::optional<StoredVolume> again;
  require(!refused([&] { again = read_stored_volume(copy); }), "what is written can be read");
  require(volume_sha256(*again) == volume_sha256(volume), "what is written is what was read");
}

/// `bytes`: of all files that its values may be from.
inline void check_volume(const std::string& path, std::size_t bytes, const ReadOptions& options) {
  std::optional<StoredVolume> stored;
  std::optional<Volume> floats;
  const bool stored_refused = refused([&] { stored = read_stored_volume(path, options, alone()); });
  const bool floats_refused = refused([&] { floats = read_volume(path, options, alone()); });
  require(stored_refused == floats_refused, "both ways of reading take the same files");
  require(!volume_files(path, options).empty(), "a volume has a file");
  if (floats_refused) return;
  // Nothing is made of nothing: deflate at most multiplies by 1032, text and bytes give one value each at most.
  require(floats->lattice().count() <= bytes * 1032, "values are from a file");
  require(volume_sha256(*stored) == volume_sha256(*floats), "both ways of reading read the same");
  check_copy(*stored);
}

}  // namespace isolux::fuzz
