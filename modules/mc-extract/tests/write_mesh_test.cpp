// Files that others open: read back by OpenMesh, by a reader of the bytes, and by MeshLab where it is installed.
// OpenMesh grows its colour arrays by T(), of which GCC 12 thinks that it may be read uninitialised.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/mc_extract.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "fields.h"
#include "mesh_laws.h"

namespace isolux {
namespace {

using namespace isolux::testing;

class WriteMesh : public ::testing::Test {
 protected:
  WriteMesh() : mesh_(extractors().create()->extract(gyroid(20), {.isovalue = 0.2f}, {})) {
    folder_ = std::filesystem::temp_directory_path() /
              ("isolux-" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + "-" +
               std::to_string(std::hash<std::string>()(::testing::TempDir()) ^ std::size_t(this)));
    std::filesystem::create_directories(folder_);
    for (std::size_t v = 0; v < mesh_.n_vertices(); ++v)
      colours_.push_back({std::uint8_t(v % 251), std::uint8_t(v % 13), std::uint8_t(255 - v % 200)});
  }
  ~WriteMesh() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Reads a file with OpenMesh, asking for all it may hold.
  static IsoMesh read(const std::string& path, OpenMesh::IO::Options::Flag wanted) {
    IsoMesh mesh;
    mesh.request_vertex_colors();
    OpenMesh::IO::Options options(wanted);
    EXPECT_TRUE(OpenMesh::IO::read_mesh(mesh, path, options)) << path;
    return mesh;
  }

  /// What a file begins with.
  static std::string head(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::string text(2000, '\0');
    file.read(text.data(), std::streamsize(text.size()));
    return text;
  }

  void expect_same(const IsoMesh& other, double tolerance) const {
    ASSERT_EQ(other.n_vertices(), mesh_.n_vertices());
    ASSERT_EQ(other.n_faces(), mesh_.n_faces());
    for (const auto v : mesh_.vertices()) {
      EXPECT_LE(glm::distance(point(mesh_, v), point(other, v)), tolerance);
      EXPECT_LE(glm::distance(normal(mesh_, v), normal(other, v)), tolerance);
    }
  }
  void expect_same_colours(const IsoMesh& other, int tolerance) const {
    for (const auto v : mesh_.vertices())
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(int(other.color(v)[c]), int(colours_[std::size_t(v.idx())][std::size_t(c)]), tolerance);
  }

  IsoMesh mesh_;
  std::vector<Rgb8> colours_;
  std::filesystem::path folder_;
};

constexpr auto kNormals = OpenMesh::IO::Options::VertexNormal;
constexpr auto kNormalsAndColours =
    OpenMesh::IO::Options::Flag(OpenMesh::IO::Options::VertexNormal | OpenMesh::IO::Options::VertexColor);

TEST_F(WriteMesh, PlyComesBackBitByBit) {
  write_mesh(mesh_, colours_, path("a.ply"));
  const IsoMesh back = read(path("a.ply"), kNormalsAndColours);
  expect_same(back, 0.0);
  expect_same_colours(back, 0);
  write_mesh(mesh_, {}, path("b.ply"));
  expect_same(read(path("b.ply"), kNormals), 0.0);
  EXPECT_EQ(std::filesystem::file_size(path("a.ply")) - std::filesystem::file_size(path("b.ply")),
            3 * mesh_.n_vertices() + std::strlen("property uchar red\nproperty uchar green\nproperty uchar blue\n"));
}

TEST_F(WriteMesh, PlyHasTheLightItselfToo) {
  std::vector<float> light;
  for (std::size_t v = 0; v < mesh_.n_vertices(); ++v) light.push_back(0.001f * float(v));
  write_mesh(mesh_, colours_, path("grey.ply"), {.light = light});
  const std::string grey = head(path("grey.ply"));
  EXPECT_NE(grey.find("property uchar blue\nproperty float quality\nelement face"), std::string::npos) << grey;
  const IsoMesh back = read(path("grey.ply"), kNormalsAndColours);
  expect_same(back, 0.0);
  expect_same_colours(back, 0);
  light.resize(3 * mesh_.n_vertices(), 0.5f);
  write_mesh(mesh_, {}, path("colour.ply"), {.light = light, .light_channels = 3});
  EXPECT_NE(head(path("colour.ply")).find("property float e_r\nproperty float e_g\nproperty float e_b\n"),
            std::string::npos);
  expect_same(read(path("colour.ply"), kNormals), 0.0);
  EXPECT_THROW(write_mesh(mesh_, {}, path("a.ply"), {.light = light, .light_channels = 2}), InvalidInput);
  EXPECT_THROW(write_mesh(mesh_, {}, path("a.obj"), {.light = light, .light_channels = 1}), InvalidInput);
  for (const std::string& extension : mesh_extensions()) {
    EXPECT_EQ(holds_light("A" + extension), extension == ".ply");
    EXPECT_EQ(holds_colours("A" + extension), extension != ".stl");
  }
}

TEST_F(WriteMesh, NotesAreComments) {
  const MeshExtras extras{.notes = {{"SPACE", "LPS"}, {"volume", "a\nend_header\xff.nrrd"}}, .name = "a at 5"};
  for (const std::string extension : {".ply", ".obj", ".glb"}) {
    write_mesh(mesh_, {}, path("a" + extension), extras);
    const std::string text = head(path("a" + extension));
    if (extension == ".glb") {
      EXPECT_NE(text.find(R"("extras":{"SPACE":"LPS",)"), std::string::npos) << text;
      EXPECT_NE(text.find(R"("name":"a at 5")"), std::string::npos) << text;
      continue;
    }
    const std::string mark = extension == ".ply" ? "comment " : "# ";
    EXPECT_NE(text.find("\n" + mark + "SPACE=LPS\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\n" + mark + "volume=a end_header\xff.nrrd\n"), std::string::npos) << text;
    expect_same(read(path("a" + extension), kNormals), extension == ".ply" ? 0.0 : 1e-6);
  }
}

TEST_F(WriteMesh, ObjComesBack) {
  write_mesh(mesh_, colours_, path("a.obj"));
  std::ifstream file(path("a.obj"));
  std::size_t vertices = 0;
  std::size_t faces = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      const OpenMesh::VertexHandle v{int(vertices++)};
      for (int a = 0; a < 3; ++a) {
        float coordinate = 0.0f;
        words >> coordinate;
        EXPECT_EQ(coordinate, mesh_.point(v)[a]);
      }
      double red = 0.0;
      words >> red;
      EXPECT_NEAR(255.0 * red, colours_[std::size_t(v.idx())][0], 0.1);
    }
    faces += kind == "f" ? 1 : 0;
  }
  EXPECT_EQ(vertices, mesh_.n_vertices());
  EXPECT_EQ(faces, mesh_.n_faces());
  write_mesh(mesh_, {}, path("b.obj"));
  expect_same(read(path("b.obj"), kNormals), 1e-6);  // OpenMesh's reader rounds
}

TEST_F(WriteMesh, OffComesBack) {
  write_mesh(mesh_, colours_, path("a.off"));
  const IsoMesh back = read(path("a.off"), kNormalsAndColours);
  expect_same(back, 1e-6);
  expect_same_colours(back, 0);
}

TEST_F(WriteMesh, StlComesBack) {
  write_mesh(mesh_, colours_, path("a.stl"));
  EXPECT_EQ(std::filesystem::file_size(path("a.stl")), 84 + 50 * mesh_.n_faces());
  EXPECT_EQ(read(path("a.stl"), OpenMesh::IO::Options::Default).n_faces(), mesh_.n_faces());
}

TEST_F(WriteMesh, GlbSaysWhatItHolds) {
  write_mesh(mesh_, colours_, path("a.glb"));
  std::ifstream file(path("a.glb"), std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  };
  ASSERT_GT(bytes.size(), 28U);
  EXPECT_EQ(std::string(bytes.data(), 4), "glTF");
  EXPECT_EQ(number(4), 2U);
  EXPECT_EQ(number(8), bytes.size());
  const std::size_t json_size = number(12);
  EXPECT_EQ(std::string(bytes.data() + 16, 4), "JSON");
  EXPECT_EQ(json_size % 4, 0U);
  const auto document = nlohmann::json::parse(bytes.begin() + 20, bytes.begin() + 20 + std::ptrdiff_t(json_size));
  EXPECT_EQ(std::memcmp(bytes.data() + 24 + json_size, "BIN\0", 4), 0);
  const std::size_t data = 28 + json_size;
  EXPECT_EQ(document["buffers"][0]["byteLength"].get<std::size_t>(), bytes.size() - data);
  const auto& primitive = document["meshes"][0]["primitives"][0];
  const auto start = [&](const nlohmann::json& accessor) {
    return data + document["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteOffset"].get<std::size_t>();
  };
  const auto& positions = document["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
  const auto& normals = document["accessors"][primitive["attributes"]["NORMAL"].get<std::size_t>()];
  const auto& colours = document["accessors"][primitive["attributes"]["COLOR_0"].get<std::size_t>()];
  const auto& indices = document["accessors"][primitive["indices"].get<std::size_t>()];
  EXPECT_EQ(positions["count"], mesh_.n_vertices());
  EXPECT_EQ(indices["count"], 3 * mesh_.n_faces());
  for (const auto v : mesh_.vertices()) {
    EXPECT_EQ(std::memcmp(bytes.data() + start(positions) + 12 * std::size_t(v.idx()), &mesh_.point(v), 12), 0);
    EXPECT_EQ(std::memcmp(bytes.data() + start(normals) + 12 * std::size_t(v.idx()), &mesh_.normal(v), 12), 0);
    for (int a = 0; a < 3; ++a) {
      EXPECT_GE(mesh_.point(v)[a], positions["min"][std::size_t(a)].get<float>());
      EXPECT_LE(mesh_.point(v)[a], positions["max"][std::size_t(a)].get<float>());
    }
  }
  std::uint16_t red = 0;
  std::memcpy(&red, bytes.data() + start(colours) + 8 * 188, 2);
  EXPECT_NEAR(red / 65535.0, 0.5029, 1e-4);  // sRGB 188 is half the light
  for (const auto f : mesh_.faces()) {
    const std::size_t at = start(indices) + 12 * std::size_t(f.idx());
    const auto [a, b, c] = corners(mesh_, f);
    std::vector<std::uint32_t> written = {number(at), number(at + 4), number(at + 8)};
    std::rotate(written.begin(), std::find(written.begin(), written.end(), std::uint32_t(a.idx())), written.end());
    EXPECT_EQ(written,
              (std::vector<std::uint32_t>{std::uint32_t(a.idx()), std::uint32_t(b.idx()), std::uint32_t(c.idx())}));
  }
}

TEST_F(WriteMesh, AnEmptyMeshIsAFileToo) {
  for (const std::string& extension : mesh_extensions()) {
    write_mesh(IsoMesh(), {}, path("empty" + extension));
    EXPECT_TRUE(std::filesystem::exists(path("empty" + extension))) << extension;
  }
}

TEST_F(WriteMesh, RefusesWhatItCannotWrite) {
  EXPECT_THROW(require_mesh_extension("a.fbx"), InvalidInput);
  for (const std::string& extension : mesh_extensions()) EXPECT_NO_THROW(require_mesh_extension("a" + extension));
  EXPECT_THROW(write_mesh(mesh_, {}, path("a.fbx")), InvalidInput);
  EXPECT_THROW(write_mesh(mesh_, {}, path("ply")), InvalidInput);
  colours_.pop_back();
  for (const std::string& extension : mesh_extensions()) {
    EXPECT_THROW(write_mesh(mesh_, colours_, path("a" + extension)), InvalidInput);
    EXPECT_THROW(write_mesh(mesh_, {}, path("no/such/folder" + extension)), IoError);
  }
}

TEST_F(WriteMesh, TellsThatTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  for (const std::string& extension : mesh_extensions()) {
    std::filesystem::create_symlink("/dev/full", path("full" + extension));
    EXPECT_THROW(write_mesh(mesh_, colours_, path("full" + extension)), IoError) << extension;
  }
}

TEST_F(WriteMesh, MeshLabOpensThem) {
  if (std::system("command -v meshlabserver > /dev/null && command -v xvfb-run > /dev/null") != 0)
    GTEST_SKIP() << "meshlabserver and xvfb-run are not installed";
  // Not .obj: Debian 12's MeshLab aborts on every OBJ file by an assertion of its own, a tetrahedron of eight lines and
  // those that it has written itself included. See AssimpOpensThem.
  for (const std::string extension : {".ply", ".off", ".stl"}) {
    const std::string from = path("a" + extension);
    const std::string to = path("from_" + extension.substr(1) + ".ply");
    const std::vector<float> light(mesh_.n_vertices(), 0.25f);
    write_mesh(mesh_, colours_, from, {.light = light, .notes = {{"SPACE", "LPS"}}});
    const std::string command =
        "timeout 100 xvfb-run -a meshlabserver -i " + from + " -o " + to + " -m vn vc > " + path("log") + " 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0) << extension;
    const IsoMesh back = read(to, kNormalsAndColours);
    EXPECT_EQ(back.n_faces(), mesh_.n_faces()) << extension;
    if (extension == ".stl") continue;
    EXPECT_EQ(back.n_vertices(), mesh_.n_vertices()) << extension;
    if (extension != ".ply") continue;
    expect_same(back, 1e-6);  // MeshLab normalises normals again
    expect_same_colours(back, 0);
  }
}

TEST_F(WriteMesh, AssimpOpensThem) {
  if (std::system("command -v assimp > /dev/null") != 0) GTEST_SKIP() << "assimp is not installed";
  for (const std::string extension : {".glb", ".obj", ".ply", ".off"}) {
    write_mesh(mesh_, colours_, path("a" + extension));
    ASSERT_EQ(std::system(("timeout 100 assimp info " + path("a" + extension) + " > " + path("log")).c_str()), 0);
    std::ifstream log(path("log"));
    std::map<std::string, std::size_t> counts;
    for (std::string line; std::getline(log, line);) {
      std::istringstream words(line);
      std::string name;
      std::size_t count = 0;
      if (words >> name >> count) counts.emplace(name, count);
    }
    EXPECT_EQ(counts["Vertices:"], mesh_.n_vertices()) << extension;
    EXPECT_EQ(counts["Faces:"], mesh_.n_faces()) << extension;
  }
}

}  // namespace
}  // namespace isolux
