#pragma once

#include <isolux/mc_extract/write_mesh.h>

#include <bit>
#include <cstring>
#include <string>
#include <vector>

namespace isolux::mc {

static_assert(std::endian::native == std::endian::little, "the writers put numbers as they lie in memory");

/// Appends a number or a plain array as it lies in memory.
template <class T>
void put(std::vector<char>& bytes, const T& value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof(T));
  std::memcpy(bytes.data() + at, &value, sizeof(T));
}

/// \throw InvalidInput unless there is one colour a vertex, or none, and light likewise.
void require_fit(const IsoMesh& mesh, std::span<const Rgb8> colours, const MeshExtras& extras);

/// The notes as "key=value", without control characters: lines of a file's header.
std::vector<std::string> note_lines(const MeshExtras& extras);

/// \throw IoError naming path.
void write_bytes(const std::vector<char>& bytes, const std::string& path);

}  // namespace isolux::mc
