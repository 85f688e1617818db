// Extraction beside its peers: the volume and what is made of it are the axes; items are triangles.
// ISOLUX_DATA names a folder with engine.nrrd and bonsai.nrrd for those two; `--benchmark_filter=gyroid` picks.
#include <benchmark/benchmark.h>
#include <isolux/mc_extract.h>
#include <isolux/volume_io/read.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <string>

#ifdef ISOLUX_BENCH_VTK
#include <SMP/Common/vtkSMPToolsAPI.h>  // vtkSMPTools.h of VTK 9.1 is not C++20
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
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

/// The volume of a subject, read once; null where its file is not there.
const Volume* volume_of(const Subject& subject) {
  static std::map<std::string, std::unique_ptr<Volume>> volumes;
  std::unique_ptr<Volume>& volume = volumes[subject.name];
  if (volume != nullptr) return volume.get();
  std::string source = subject.source;
  if (!source.starts_with("gen:")) {
    const char* folder = std::getenv("ISOLUX_DATA");
    if (folder == nullptr) return nullptr;
    source = std::string(folder) + "/" + source;
  }
  volume = std::make_unique<Volume>(read_volume(source));
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
void fresh(benchmark::State& state, const Subject& subject) {
  const Volume* volume = volume_of(subject);
  if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
  std::size_t triangles = 0;
  for (auto _ : state) {
    Mesh mesh;
    IsoExtractor(*volume, run_of(state), IsoExtractor::Index::kNone)
        .extract({.isovalue = subject.isovalue}, run_of(state), mesh);
    triangles = triangle_count(mesh);
  }
  report(state, triangles);
}

template <class Mesh>
void kept(benchmark::State& state, const Subject& subject, IsoExtractor::Index index) {
  const Volume* volume = volume_of(subject);
  if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
  IsoExtractor extractor(*volume, run_of(state), index);
  Mesh mesh;
  extractor.extract({.isovalue = subject.isovalue}, run_of(state), mesh);
  for (auto _ : state) extractor.extract({.isovalue = subject.isovalue}, run_of(state), mesh);
  report(state, triangle_count(mesh));
}

void index_build(benchmark::State& state, const Subject& subject) {
  const Volume* volume = volume_of(subject);
  if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
  for (auto _ : state) IsoExtractor(*volume, run_of(state), IsoExtractor::Index::kBricks);
}

void backend(benchmark::State& state, const Subject& subject, const std::string& name) {
  const Volume* volume = volume_of(subject);
  if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
  const auto extractor = extractors().create(name);
  std::size_t triangles = 0;
  for (auto _ : state) triangles = extractor->extract(*volume, {.isovalue = subject.isovalue}, run_of(state)).n_faces();
  report(state, triangles);
}

/// What OpenMesh's own way would add to an indexed mesh.
void openmesh_add_face(benchmark::State& state, const Subject& subject) {
  const Volume* volume = volume_of(subject);
  if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
  IndexedMesh indexed;
  IsoExtractor(*volume).extract({.isovalue = subject.isovalue}, run_of(state), indexed);
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
void vtk_flying_edges(benchmark::State& state, const Subject& subject) {
  const Volume* volume = volume_of(subject);
  if (volume == nullptr) return state.SkipWithError("ISOLUX_DATA is not set");
  vtk::detail::smp::vtkSMPToolsAPI::GetInstance().Initialize(int(state.range(0)));
  const Index3 size = volume->lattice().size;
  const auto values = vtkSmartPointer<vtkFloatArray>::New();
  values->SetArray(const_cast<float*>(volume->values.values().data()), vtkIdType(volume->lattice().count()), 1);
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(size.x, size.y, size.z);
  image->GetPointData()->SetScalars(values);
  std::size_t triangles = 0;
  for (auto _ : state) {
    const auto filter = vtkSmartPointer<vtkFlyingEdges3D>::New();
    filter->SetInputData(image);
    filter->SetValue(0, subject.isovalue);
    filter->ComputeNormalsOn();
    filter->ComputeScalarsOff();
    filter->ComputeGradientsOff();
    filter->Update();
    triangles = std::size_t(filter->GetOutput()->GetNumberOfPolys());
  }
  report(state, triangles);
}
#endif

void register_all() {
  for (const Subject& subject : kSubjects) {
    const auto add = [&](const std::string& what, auto function) {
      for (const int threads : {1, 2})
        benchmark::RegisterBenchmark((std::string(subject.name) + "/" + what).c_str(),
                                     [function, &subject](benchmark::State& state) { function(state, subject); })
            ->Arg(threads)
            ->ArgName("threads")
            ->UseRealTime()
            ->Unit(benchmark::kMillisecond);
    };
    using Index = IsoExtractor::Index;
#ifdef ISOLUX_BENCH_VTK
    add("vtk_flying_edges", vtk_flying_edges);
#endif
    add("indexed_fresh", fresh<IndexedMesh>);
    add("indexed_kept", [](auto& state, auto& s) { kept<IndexedMesh>(state, s, Index::kNone); });
    add("indexed_kept_index", [](auto& state, auto& s) { kept<IndexedMesh>(state, s, Index::kBricks); });
    add("half_edges_fresh", fresh<IsoMesh>);
    add("half_edges_kept", [](auto& state, auto& s) { kept<IsoMesh>(state, s, Index::kNone); });
    add("half_edges_kept_index", [](auto& state, auto& s) { kept<IsoMesh>(state, s, Index::kBricks); });
    add("index_build", index_build);
    add("openmesh_add_face", openmesh_add_face);
    const Registry<Extractor> registry = extractors();
    for (const BackendInfo& info : registry.backends())
      add("backend_" + info.name, [name = info.name](auto& state, auto& s) { backend(state, s, name); });
  }
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  register_all();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
