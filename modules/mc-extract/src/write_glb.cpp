#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "mesh_bytes.h"

namespace isolux {

namespace {

using nlohmann::json;

constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kUnsignedShort = 5123;
constexpr int kVertexBuffer = 34962;
constexpr int kIndexBuffer = 34963;

/// glTF's vertex colours are linear; 16 bits keep the dark ones apart.
std::uint16_t linear16(std::uint8_t srgb) {
  const double s = srgb / 255.0;
  const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  return std::uint16_t(std::lround(65535.0 * linear));
}

/// The binary chunk, with the views and accessors that describe it.
struct GlbBuffer {
  std::vector<char> bytes;
  json views = json::array();
  json accessors = json::array();

  /// Describes what was put since `start` as the next accessor; returns its number.
  std::size_t describe(std::size_t start, int target, int component, const char* type, std::size_t count,
                       json extra = json::object()) {
    views.push_back({{"buffer", 0}, {"byteOffset", start}, {"byteLength", bytes.size() - start}, {"target", target}});
    extra.update({{"bufferView", views.size() - 1}, {"componentType", component}, {"type", type}, {"count", count}});
    accessors.push_back(std::move(extra));
    return accessors.size() - 1;
  }
};

json put_vertices(const IsoMesh& mesh, std::span<const Rgb8> colours, GlbBuffer& buffer) {
  json attributes;
  std::array<float, 3> low;
  std::array<float, 3> high;
  low.fill(std::numeric_limits<float>::max());
  high.fill(std::numeric_limits<float>::lowest());
  std::size_t start = buffer.bytes.size();
  for (const auto v : mesh.vertices()) {
    const auto& p = mesh.point(v);
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], p[int(a)]);
      high[a] = std::max(high[a], p[int(a)]);
    }
    mc::put(buffer.bytes, p);
  }
  const std::size_t count = mesh.n_vertices();
  attributes["POSITION"] = buffer.describe(start, kVertexBuffer, kFloat, "VEC3", count, {{"min", low}, {"max", high}});
  start = buffer.bytes.size();
  for (const auto v : mesh.vertices()) mc::put(buffer.bytes, mesh.normal(v));
  attributes["NORMAL"] = buffer.describe(start, kVertexBuffer, kFloat, "VEC3", count);
  if (colours.empty()) return attributes;
  start = buffer.bytes.size();
  for (const Rgb8& c : colours)
    mc::put(buffer.bytes, std::array<std::uint16_t, 4>{linear16(c[0]), linear16(c[1]), linear16(c[2]), 65535});
  attributes["COLOR_0"] = buffer.describe(start, kVertexBuffer, kUnsignedShort, "VEC4", count, {{"normalized", true}});
  return attributes;
}

/// The mesh of one primitive and the node that shows it.
void put_node(json primitive, const MeshExtras& extras, json& document) {
  json mesh = {{"primitives", json::array({std::move(primitive)})}};
  json node = {{"mesh", 0}};
  if (!extras.name.empty()) mesh["name"] = node["name"] = extras.name;
  for (const auto& [key, value] : extras.notes) node["extras"][key] = value;
  document["meshes"] = json::array({std::move(mesh)});
  document["nodes"] = json::array({std::move(node)});
}

void put_chunk(std::vector<char>& file, const char* type, std::vector<char> content, char padding) {
  content.resize((content.size() + 3) / 4 * 4, padding);
  mc::put(file, std::uint32_t(content.size()));
  file.insert(file.end(), type, type + 4);
  file.insert(file.end(), content.begin(), content.end());
}

}  // namespace

void write_glb(const IsoMesh& mesh, std::span<const Rgb8> colours, const std::string& path, const MeshExtras& extras) {
  mc::require_fit(mesh, colours, extras);
  const std::size_t estimate = mesh.n_vertices() * 32 + mesh.n_faces() * 12 + 4096;
  if (estimate > std::numeric_limits<std::uint32_t>::max())
    throw InvalidInput(fmt::format("{}: a mesh of {} triangles does not fit the 4 GiB of a .glb file: write .ply", path,
                                   mesh.n_faces()));
  json document = {{"asset", {{"version", "2.0"}, {"generator", "isolux"}}}};
  GlbBuffer buffer;
  // An empty mesh cannot be said in glTF, an empty scene can.
  json scene = json::object();
  if (mesh.n_faces() > 0) {
    const json attributes = put_vertices(mesh, colours, buffer);
    const std::size_t start = buffer.bytes.size();
    for (const auto f : mesh.faces())
      for (const auto v : mesh.fv_range(f)) mc::put(buffer.bytes, std::uint32_t(v.idx()));
    const std::size_t indices = buffer.describe(start, kIndexBuffer, kUnsignedInt, "SCALAR", 3 * mesh.n_faces());
    json material = {{"doubleSided", true},
                     {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 1.0}}}};
    if (!colours.empty()) {
      material["extensions"] = {{"KHR_materials_unlit", json::object()}};
      document["extensionsUsed"] = {"KHR_materials_unlit"};
    }
    document["materials"] = json::array({material});
    put_node({{"attributes", attributes}, {"indices", indices}, {"material", 0}}, extras, document);
    document["bufferViews"] = buffer.views;
    document["accessors"] = buffer.accessors;
    document["buffers"] = json::array({{{"byteLength", buffer.bytes.size()}}});
    scene["nodes"] = {0};
  }
  document["scenes"] = json::array({scene});
  document["scene"] = 0;

  // Names may be of files, whose bytes need not be UTF-8.
  const std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace);
  std::vector<char> chunks;
  put_chunk(chunks, "JSON", {text.begin(), text.end()}, ' ');
  if (!buffer.bytes.empty()) put_chunk(chunks, "BIN\0", std::move(buffer.bytes), '\0');
  std::vector<char> file = {'g', 'l', 'T', 'F'};
  mc::put(file, std::uint32_t(2));
  mc::put(file, std::uint32_t(12 + chunks.size()));
  file.insert(file.end(), chunks.begin(), chunks.end());
  mc::write_bytes(file, path);
}

}  // namespace isolux
