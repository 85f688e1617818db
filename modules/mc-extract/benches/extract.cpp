// Extraction beside its peers: the volume and what is made of it are the axes; items are triangles.
// ISOLUX_DATA names a folder with engine.nrrd and bonsai.nrrd for those two; `--benchmark_filter=gyroid` picks.
#include <benchmark/benchmark.h>
#include <isolux/mc_extract.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#ifdef ISOLUX_BENCH_VTK
#include <SMP/Common/vtkSMPToolsAPI.h>  // vtkSMPTools.h of VTK 9.1 is not C++20
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#endif

namespace {

using namespace isolux;

struct Subject {
  const char* name;
  const char* source;  ///< `gen:` text, or a file of ISOLUX_DATA
  float isovalue;
  [[nodiscard]] bool is_file() const { return !std::string(source).starts_with("gen:"); }
};

constexpr Subject kSubjects[] = {{"gyroid256", "gen:gyroid:256", 0.1f},
                                 {"marschner_lobb256", "gen:marschner-lobb:256", 0.5f},
                                 {"engine", "engine.nrrd", 110.0f},
                                 {"bonsai", "bonsai.nrrd", 40.0f}};

/// Small surfaces (about 10^5 triangles) in large volumes: what a search has to find. In one place, and everywhere.
constexpr Subject kSparseSubjects[] = {{"sphere512", "gen:sphere:512", -0.12f}, {"gyroid512", "gen:gyroid:512", 1.49f}};

/// The type that voxels are held in: the file's own (8 bits for engine and bonsai), or floats. Built-in fields have
/// floats alone.
enum class Held : std::uint8_t { kAsStored, kInFloats };

struct Voxels {
  std::optional<StoredVolume> file;
  Volume floats;
  [[nodiscard]] VolumeView view(Held held = Held::kAsStored) const {
    return file && held == Held::kAsStored ? VolumeView(*file) : VolumeView(floats);
  }
};

/// The volume of a subject, read once; null where its file is not there.
const Voxels* volume_of(const Subject& subject) {
  static std::map<std::string, std::unique_ptr<Voxels>> volumes;
  std::unique_ptr<Voxels>& volume = volumes[subject.name];
  if (volume != nullptr) return volume.get();
  std::erase_if(volumes, [&](const auto& other) { return other.second != nullptr; });  // one at a time fits
  if (!subject.is_file()) {
    volume = std::make_unique<Voxels>(Voxels{.file = {}, .floats = read_volume(subject.source)});
  } else if (const char* folder = std::getenv("ISOLUX_DATA")) {
    StoredVolume file = read_stored_volume(std::string(folder) + "/" + subject.source);
    volume = std::make_unique<Voxels>(Voxels{.file = file, .floats = to_floats(file)});
  }
  return volume.get();
}

void report(benchmark::State& state, std::size_t triangles) {
  state.SetItemsProcessed(std::int64_t(state.iterations()) * std::int64_t(triangles));
  state.counters["triangles"] = double(triangles);
}

Run run_of(const benchmark::State& state) { return {.threads = int(state.range(0))}; }

template <class Mesh>
std::size_t triangle_count(const Mesh& mesh) {
  if constexpr (std::is_same_v<Mesh, IndexedMesh>)
    return mesh.triangles.size();
  else
    return mesh.n_faces();
}

template <class Mesh>
void fresh(benchmark::State& state, const Voxels& volume, const Subject& subject, Held held) {
  std::size_t triangles = 0;
  for (auto _ : state) {
    Mesh mesh;
    IsoExtractor(volume.view(held), run_of(state), IsoExtractor::Index::kNone)
        .extract({.isovalue = subject.isovalue}, run_of(state), mesh);
    triangles = triangle_count(mesh);
  }
  report(state, triangles);
}

template <class Mesh>
void kept(benchmark::State& state, const Voxels& volume, const Subject& subject, Held held, IsoExtractor::Index index) {
  IsoExtractor extractor(volume.view(held), run_of(state), index);
  Mesh mesh;
  extractor.extract({.isovalue = subject.isovalue}, run_of(state), mesh);
  for (auto _ : state) extractor.extract({.isovalue = subject.isovalue}, run_of(state), mesh);
  report(state, triangle_count(mesh));
}

/// 50 isovalues through the middle 90 % of the range; the time is of one.
constexpr int kSweep = 50;

std::vector<float> sweep_isovalues(const Volume& volume) {
  const auto [low, high] = std::ranges::minmax(volume.values.values());
  std::vector<float> isovalues;
  for (int n = 0; n < kSweep; ++n)
    isovalues.push_back(low + (high - low) * (0.05f + 0.9f * float(n) / float(kSweep - 1)));
  return isovalues;
}

void report_sweep(benchmark::State& state, std::size_t triangles) {
  report(state, triangles);
  state.counters["ms_each"] = benchmark::Counter(
      double(kSweep) * 1e-3, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void sweep(benchmark::State& state, const Voxels& volume, const Subject& /*subject*/, Held held,
           IsoExtractor::Index index) {
  const std::vector<float> isovalues = sweep_isovalues(volume.floats);
  IsoExtractor extractor(volume.view(held), run_of(state), index);
  IndexedMesh mesh;
  std::size_t triangles = 0;
  for (auto _ : state) {
    triangles = 0;
    for (const float isovalue : isovalues) {
      extractor.extract({.isovalue = isovalue}, run_of(state), mesh);
      triangles += mesh.triangles.size();
    }
  }
  report_sweep(state, triangles);
}

void index_build(benchmark::State& state, const Voxels& volume, const Subject& /*subject*/, Held held) {
  for (auto _ : state) IsoExtractor(volume.view(held), run_of(state));
}

void accurate_normals(benchmark::State& state, const Voxels& volume, const Subject& subject) {
  IndexedMesh mesh;
  IsoExtractor(volume.view()).extract({.isovalue = subject.isovalue}, run_of(state), mesh);
  for (auto _ : state) set_accurate_normals(volume.view(), OuterSide::kLower, run_of(state), mesh);
  report(state, mesh.triangles.size());
}

void backend(benchmark::State& state, const Voxels& volume, const Subject& subject, const std::string& name) {
  const auto extractor = extractors().create(name);
  std::size_t triangles = 0;
  for (auto _ : state)
    triangles = extractor->extract(volume.view(), {.isovalue = subject.isovalue}, run_of(state)).n_faces();
  report(state, triangles);
}

/// OpenMesh's own way, beside an indexed mesh.
void openmesh_add_face(benchmark::State& state, const Voxels& volume, const Subject& subject) {
  IndexedMesh indexed;
  IsoExtractor(volume.view()).extract({.isovalue = subject.isovalue}, run_of(state), indexed);
  for (auto _ : state) {
    IsoMesh mesh;
    mesh.reserve(indexed.positions.size(), 3 * indexed.triangles.size() / 2, indexed.triangles.size());
    for (const Vec3f& p : indexed.positions) mesh.add_vertex({p.x, p.y, p.z});
    for (const Triangle& t : indexed.triangles)
      mesh.add_face(OpenMesh::VertexHandle(int(t[0])), OpenMesh::VertexHandle(int(t[1])),
                    OpenMesh::VertexHandle(int(t[2])));
    mesh.request_face_normals();
    mesh.update_normals();
  }
  report(state, indexed.triangles.size());
}

#ifdef ISOLUX_BENCH_VTK
/// Of floats or bytes, which it reads in place.
class FlyingEdges {
 public:
  FlyingEdges(const VolumeView& volume, int threads) {
    vtk::detail::smp::vtkSMPToolsAPI::GetInstance().Initialize(threads);
    const Index3 size = volume.lattice().size;
    image_->SetDimensions(size.x, size.y, size.z);
    if (const auto* floats = std::get_if<std::span<const float>>(&volume.voxels()))
      set_values(vtkSmartPointer<vtkFloatArray>::New(), *floats);
    else
      set_values(vtkSmartPointer<vtkUnsignedCharArray>::New(),
                 std::get<std::span<const std::uint8_t>>(volume.voxels()));
  }
  /// Triangles of the level set, extracted with normals.
  [[nodiscard]] std::size_t extract(float isovalue) const {
    const auto filter = vtkSmartPointer<vtkFlyingEdges3D>::New();
    filter->SetInputData(image_);
    filter->SetValue(0, isovalue);
    filter->ComputeNormalsOn();
    filter->ComputeScalarsOff();
    filter->ComputeGradientsOff();
    filter->Update();
    return std::size_t(filter->GetOutput()->GetNumberOfPolys());
  }

 private:
  template <class Value>
  void set_values(const auto& array, std::span<const Value> values) {
    array->SetArray(const_cast<Value*>(values.data()), vtkIdType(values.size()), 1);
    image_->GetPointData()->SetScalars(array);
  }
  vtkSmartPointer<vtkImageData> image_ = vtkSmartPointer<vtkImageData>::New();
};

void vtk_flying_edges(benchmark::State& state, const Voxels& volume, const Subject& subject, Held held) {
  const FlyingEdges flying_edges(volume.view(held), int(state.range(0)));
  std::size_t triangles = 0;
  for (auto _ : state) triangles = flying_edges.extract(subject.isovalue);
  report(state, triangles);
}

void vtk_sweep(benchmark::State& state, const Voxels& volume, const Subject& /*subject*/) {
  const FlyingEdges flying_edges(volume.floats, int(state.range(0)));
  const std::vector<float> isovalues = sweep_isovalues(volume.floats);
  std::size_t triangles = 0;
  for (auto _ : state) {
    triangles = 0;
    for (const float isovalue : isovalues) triangles += flying_edges.extract(isovalue);
  }
  report_sweep(state, triangles);
}
#endif

void add(const Subject& subject, const std::string& what, auto function) {
  for (const int threads : {1, 2})
    benchmark::RegisterBenchmark((std::string(subject.name) + "/" + what).c_str(),
                                 [function, &subject](benchmark::State& state) {
                                   const Voxels* volume = volume_of(subject);
                                   if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
                                   function(state, *volume, subject);
                                 })
        ->Arg(threads)
        ->ArgName("threads")
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
}

using Index = IsoExtractor::Index;

void add_rows(const Subject& subject, Held held, const std::string& as) {
  add(subject, "indexed_fresh" + as, [held](auto& state, auto& v, auto& s) { fresh<IndexedMesh>(state, v, s, held); });
  add(subject, "half_edges_fresh" + as, [held](auto& state, auto& v, auto& s) { fresh<IsoMesh>(state, v, s, held); });
  add(subject, "index_build" + as, [held](auto& state, auto& v, auto& s) { index_build(state, v, s, held); });
  for (const Index index : {Index::kNone, Index::kBricks}) {
    const std::string row = (index == Index::kBricks ? "_index" : "") + as;
    add(subject, "indexed_kept" + row,
        [=](auto& state, auto& v, auto& s) { kept<IndexedMesh>(state, v, s, held, index); });
    add(subject, "half_edges_kept" + row,
        [=](auto& state, auto& v, auto& s) { kept<IsoMesh>(state, v, s, held, index); });
    add(subject, "sweep" + row, [=](auto& state, auto& v, auto& s) { sweep(state, v, s, held, index); });
  }
}

#ifdef ISOLUX_BENCH_VTK
void add_flying_edges(const Subject& subject, Held held, const std::string& as) {
  add(subject, "vtk_flying_edges" + as, [held](auto& state, auto& v, auto& s) { vtk_flying_edges(state, v, s, held); });
}
#endif

void register_dense(const Subject& subject) {
#ifdef ISOLUX_BENCH_VTK
  add_flying_edges(subject, Held::kInFloats, "");
  if (subject.is_file()) add_flying_edges(subject, Held::kAsStored, "_u8");
  add(subject, "vtk_sweep", vtk_sweep);
#endif
  add_rows(subject, Held::kAsStored, "");
  if (subject.is_file()) add_rows(subject, Held::kInFloats, "_floats");
  add(subject, "accurate_normals", accurate_normals);
  add(subject, "openmesh_add_face", openmesh_add_face);
  const Registry<Extractor> registry = extractors();
  for (const BackendInfo& info : registry.backends())
    add(subject, "backend_" + info.name,
        [name = info.name](auto& state, auto& v, auto& s) { backend(state, v, s, name); });
}

void register_sparse(const Subject& subject) {
#ifdef ISOLUX_BENCH_VTK
  add_flying_edges(subject, Held::kInFloats, "");
#endif
  add_rows(subject, Held::kAsStored, "");
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (const Subject& subject : kSubjects) register_dense(subject);
  for (const Subject& subject : kSparseSubjects) register_sparse(subject);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
