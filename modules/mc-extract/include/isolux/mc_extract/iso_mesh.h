#pragma once

// OpenMesh's own headers do not pass our warnings.
#pragma GCC system_header

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

namespace isolux {

struct IsoMeshTraits : OpenMesh::DefaultTraits {
  VertexAttributes(OpenMesh::Attributes::Normal);
};

/// A triangle half-edge mesh: points in world space, unit vertex normals towards the outer side, faces
/// counter-clockwise seen from there. 3 floats a point and a normal.
using IsoMesh = OpenMesh::TriMesh_ArrayKernelT<IsoMeshTraits>;

}  // namespace isolux
