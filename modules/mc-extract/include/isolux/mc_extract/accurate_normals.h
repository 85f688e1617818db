#pragma once

#include <isolux/core/field.h>
#include <isolux/core/run.h>
#include <isolux/core/volume.h>
#include <isolux/mc_extract/indexed_mesh.h>
#include <isolux/mc_extract/iso_mesh.h>

namespace isolux {

/// Replaces the vertex normals of a level set's mesh, whichever way it was extracted, by those of the gradient of the
/// polynomials through the nearest six or seven voxels of each axis (nine from one side at the box's faces), taken at
/// the vertex itself: of sixth order, where central differences interpolated along the edge are of second.
///
/// Noise would be amplified (twice inside, thirty times at the box's faces), so it is done only as far as the data are
/// smooth: where the sixth differences of the voxels around are not smaller than the fourth, four or five voxels serve,
/// and where the fourth are not smaller than the second, the normal stays as it is, as it does beside voxels that are
/// not finite. Vertices on grid points, which only a cap has, keep theirs.
///
/// `outer`: as the mesh was extracted. About .3 us a vertex and thread; the same bits for any number of threads.
/// \pre the mesh lies in the volume's box, world space. \throw Cancelled
void set_accurate_normals(const VolumeView& volume, OuterSide outer, const Run& run, IndexedMesh& mesh);
void set_accurate_normals(const VolumeView& volume, OuterSide outer, const Run& run, IsoMesh& mesh);

}  // namespace isolux
