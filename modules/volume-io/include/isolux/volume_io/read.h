#pragma once

#include <isolux/volume_io/volume_reader.h>

#include <string>
#include <vector>

namespace isolux {

/// Reads a volume argument in floats: `gen:NAME[:N]`, a file told by content and then by extension, or a folder of
/// DICOM slices; with whichever reader of `registry` claims it most surely. `run.seed` seeds `gen:noise`. \throw
/// IoError, InvalidInput as VolumeReader::read; InvalidInput naming the known formats if nobody claims it, or for
/// ReadOptions::settings that a reader does not take.
[[nodiscard]] Volume read_volume(const std::string& source, const ReadOptions& options, const Run& run,
                                 const Registry<VolumeReader>& registry);
/// With the readers of this build.
[[nodiscard]] Volume read_volume(const std::string& source, const ReadOptions& options = {}, const Run& run = {});

/// The same in the type that the file stores, where that is whole numbers of 8 or 16 bits: they are never floats on the
/// way. What is scaled by its header, or is written as text, comes in floats.
[[nodiscard]] StoredVolume read_stored_volume(const std::string& source, const ReadOptions& options, const Run& run,
                                              const Registry<VolumeReader>& registry);
[[nodiscard]] StoredVolume read_stored_volume(const std::string& source, const ReadOptions& options = {},
                                              const Run& run = {});

/// The files that reading a source takes, data files of headers and a folder's slices among them, in the order of
/// VolumeReader::files(): what a program must not replace. Of what cannot be read, `source` alone.
[[nodiscard]] std::vector<std::string> volume_files(const std::string& source, const ReadOptions& options,
                                                    const Registry<VolumeReader>& registry);
[[nodiscard]] std::vector<std::string> volume_files(const std::string& source, const ReadOptions& options = {});

/// Whether a source is read as headerless: else ReadOptions::raw and big_endian change nothing. \throw as read_volume()
/// where nobody claims it
[[nodiscard]] bool takes_layout(const std::string& source, const ReadOptions& options,
                                const Registry<VolumeReader>& registry);
[[nodiscard]] bool takes_layout(const std::string& source, const ReadOptions& options = {});

/// SHA-256 over size, frame and values as floats (little endian), the same whichever type they are held in: what ties a
/// light file to its volume, in lower-case hexadecimal.
[[nodiscard]] std::string volume_sha256(const VolumeView& volume);

}  // namespace isolux
