#include "peer_vtk.h"

#ifdef ISOLUX_HAS_VTK
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>
#include <vtkVersion.h>

#include <algorithm>
#include <chrono>
#endif

namespace isolux::bench {

#ifdef ISOLUX_HAS_VTK
VtkExtraction vtk_flying_edges(const std::vector<float>& values, int n, float isovalue, int threads, int runs) {
  vtkSMPTools::Initialize(threads);
  vtkNew<vtkFloatArray> array;
  array->SetNumberOfComponents(1);
  array->SetNumberOfTuples(vtkIdType(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  vtkNew<vtkImageData> image;
  image->SetDimensions(n, n, n);
  image->SetSpacing(1.0 / (n - 1), 1.0 / (n - 1), 1.0 / (n - 1));
  image->GetPointData()->SetScalars(array);
  VtkExtraction result;
  for (int run = 0; run <= runs; ++run) {
    const auto start = std::chrono::steady_clock::now();
    vtkNew<vtkFlyingEdges3D> filter;
    filter->SetInputData(image);
    filter->SetValue(0, double(isovalue));
    filter->ComputeNormalsOn();
    filter->ComputeGradientsOff();
    filter->ComputeScalarsOff();
    filter->Update();
    result.triangles = std::size_t(filter->GetOutput()->GetNumberOfPolys());
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    if (run > 0) result.seconds.push_back(spent.count());
  }
  return result;
}

std::string vtk_version() { return std::string(vtkVersion::GetVTKVersion()) + ", vtkFlyingEdges3D with normals"; }
#else
VtkExtraction vtk_flying_edges(const std::vector<float>& /*values*/, int /*n*/, float /*isovalue*/, int /*threads*/,
                               int /*runs*/) {
  return {};
}

std::string vtk_version() { return "not in this build"; }
#endif

}  // namespace isolux::bench
