// Extraction beside its peers: the volume and what is made of it are the axes; items are triangles.
// ISOLUX_DATA names a folder with engine.nrrd and bonsai.nrrd for those two; `--benchmark_filter=gyroid` picks.
#include <benchmark/benchmark.h>
#include <isolux/mc_extract.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>
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
  StoredVolume stored;
  Volume floats;
  [[nodiscard]] VolumeView view(Held held) const {
    return held == Held::kAsStored ? VolumeView(stored) : VolumeView(floats);
  }
};

/// The volume of a subject, read once; null where its file is not there.
const Voxels* volume_of(const Subject& subject) {
  static std::map<std::string, std::unique_ptr<Voxels>> volumes;
  std::unique_ptr<Voxels>& volume = volumes[subject.name];
  if (volume != nullptr) return volume.get();
  std::erase_if(volumes, [&](const auto& other) { return other.second != nullptr; });  // one at a time fits
  std::string source = subject.source;
  if (!source.starts_with("gen:")) {
    const char* folder = std::getenv("ISOLUX_DATA");
    if (folder == nullptr) return nullptr;
    source = std::string(folder) + "/" + source;
  }
  volume = std::make_unique<Voxels>(Voxels{.stored = read_stored_volume(source), .floats = read_volume(source)});
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
void fresh(benchmark::State& state, const Subject& subject, Held held) {
  const Voxels* volume = volume_of(subject);
  if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
  std::size_t triangles = 0;
  for (auto _ : state) {
    Mesh mesh;
    IsoExtractor(volume->view(held), run_of(state), IsoExtractor::Index::kNone)
        .extract({.isovalue = subject.isovalue}, run_of(state), mesh);
    triangles = triangle_count(mesh);
  }
  report(state, triangles);
}

template <class Mesh>
void kept(benchmark::State& state, const Subject& subject, Held held, IsoExtractor::Index index) {
  const Voxels* volume = volume_of(subject);
  if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
  IsoExtractor extractor(volume->view(held), run_of(state), index);
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

void sweep(benchmark::State& state, const Subject& subject, Held held, IsoExtractor::Index index) {
  const Voxels* volume = volume_of(subject);
  if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
  const std::vector<float> isovalues = sweep_isovalues(volume->floats);
  IsoExtractor extractor(volume->view(held), run_of(state), index);
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

void index_build(benchmark::State& state, const Subject& subject, Held held) {
  const Voxels* volume = volume_of(subject);
  if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
  for (auto _ : state) IsoExtractor(volume->view(held), run_of(state));
}

void accurate_normals(benchmark::State& state, const Subject& subject) {
  const Voxels* volume = volume_of(subject);
  if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
  IndexedMesh mesh;
  IsoExtractor(volume->stored).extract({.isovalue = subject.isovalue}, run_of(state), mesh);
  for (auto _ : state) set_accurate_normals(volume->stored, OuterSide::kLower, run_of(state), mesh);
  report(state, mesh.triangles.size());
}

void backend(benchmark::State& state, const Subject& subject, const std::string& name) {
  const Voxels* volume = volume_of(subject);
  if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
  const auto extractor = extractors().create(name);
  std::size_t triangles = 0;
  for (auto _ : state)
    triangles = extractor->extract(volume->stored, {.isovalue = subject.isovalue}, run_of(state)).n_faces();
  report(state, triangles);
}

/// OpenMesh's own way, beside an indexed mesh.
void openmesh_add_face(benchmark::State& state, const Subject& subject) {
  const Voxels* volume = volume_of(subject);
  if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
  IndexedMesh indexed;
  IsoExtractor(volume->stored).extract({.isovalue = subject.isovalue}, run_of(state), indexed);
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
class FlyingEdges {
 public:
  enum class Values : std::uint8_t { kFloat, kByte };
  FlyingEdges(const Volume& volume, int threads, Values type = Values::kFloat) {
    vtk::detail::smp::vtkSMPToolsAPI::GetInstance().Initialize(threads);
    const Index3 size = volume.lattice().size;
    image_->SetDimensions(size.x, size.y, size.z);
    const auto values = volume.values.values();
    if (type == Values::kFloat) {
      const auto floats = vtkSmartPointer<vtkFloatArray>::New();
      floats->SetArray(const_cast<float*>(values.data()), vtkIdType(values.size()), 1);
      image_->GetPointData()->SetScalars(floats);
    } else {
      const auto bytes = vtkSmartPointer<vtkUnsignedCharArray>::New();
      bytes->SetNumberOfValues(vtkIdType(values.size()));
      std::transform(values.begin(), values.end(), bytes->GetPointer(0), [](float v) { return std::uint8_t(v); });
      image_->GetPointData()->SetScalars(bytes);
    }
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
  vtkSmartPointer<vtkImageData> image_ = vtkSmartPointer<vtkImageData>::New();
};

void vtk_flying_edges(benchmark::State& state, const Subject& subject) {
  const Voxels* volume = volume_of(subject);
  if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
  const FlyingEdges flying_edges(volume->floats, int(state.range(0)));
  std::size_t triangles = 0;
  for (auto _ : state) triangles = flying_edges.extract(subject.isovalue);
  report(state, triangles);
}

/// On bytes, as the file has them: a quarter of the memory.
void vtk_flying_edges_u8(benchmark::State& state, const Subject& subject) {
  const Voxels* volume = volume_of(subject);
  if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
  if (volume->stored.stored_type != ScalarType::kUint8) return state.SkipWithError("not a volume of bytes");
  const FlyingEdges flying_edges(volume->floats, int(state.range(0)), FlyingEdges::Values::kByte);
  std::size_t triangles = 0;
  for (auto _ : state) triangles = flying_edges.extract(subject.isovalue);
  report(state, triangles);
}

void vtk_sweep(benchmark::State& state, const Subject& subject) {
  const Voxels* volume = volume_of(subject);
  if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
  const FlyingEdges flying_edges(volume->floats, int(state.range(0)));
  const std::vector<float> isovalues = sweep_isovalues(volume->floats);
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
                                 [function, &subject](benchmark::State& state) { function(state, subject); })
        ->Arg(threads)
        ->ArgName("threads")
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
}

using Index = IsoExtractor::Index;

void add_rows(const Subject& subject, Held held, const std::string& as) {
  add(subject, "indexed_fresh" + as, [held](auto& state, auto& s) { fresh<IndexedMesh>(state, s, held); });
  add(subject, "half_edges_fresh" + as, [held](auto& state, auto& s) { fresh<IsoMesh>(state, s, held); });
  add(subject, "index_build" + as, [held](auto& state, auto& s) { index_build(state, s, held); });
  for (const Index index : {Index::kNone, Index::kBricks}) {
    const std::string row = (index == Index::kBricks ? "_index" : "") + as;
    add(subject, "indexed_kept" + row, [=](auto& state, auto& s) { kept<IndexedMesh>(state, s, held, index); });
    add(subject, "half_edges_kept" + row, [=](auto& state, auto& s) { kept<IsoMesh>(state, s, held, index); });
    add(subject, "sweep" + row, [=](auto& state, auto& s) { sweep(state, s, held, index); });
  }
}

void register_dense(const Subject& subject) {
#ifdef ISOLUX_BENCH_VTK
  add(subject, "vtk_flying_edges", vtk_flying_edges);
  if (!std::string(subject.source).starts_with("gen:")) add(subject, "vtk_flying_edges_u8", vtk_flying_edges_u8);
  add(subject, "vtk_sweep", vtk_sweep);
#endif
  for (const Held held : {Held::kAsStored, Held::kInFloats}) {
    if (held == Held::kInFloats && std::string(subject.source).starts_with("gen:")) continue;
    add_rows(subject, held, held == Held::kInFloats ? "_floats" : "");
  }
  add(subject, "accurate_normals", accurate_normals);
  add(subject, "openmesh_add_face", openmesh_add_face);
  const Registry<Extractor> registry = extractors();
  for (const BackendInfo& info : registry.backends())
    add(subject, "backend_" + info.name, [name = info.name](auto& state, auto& s) { backend(state, s, name); });
}

void register_sparse(const Subject& subject) {
#ifdef ISOLUX_BENCH_VTK
  add(subject, "vtk_flying_edges", vtk_flying_edges);
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
