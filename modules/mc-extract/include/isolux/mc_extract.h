// The front page of mc-extract: isosurfaces as OpenMesh half-edge meshes with smoothed vertex normals.
#pragma once

#include <isolux/core/error.h>
#include <isolux/mc_extract/accurate_normals.h>
#include <isolux/mc_extract/cap_vertices.h>
#include <isolux/mc_extract/extractor.h>
#include <isolux/mc_extract/indexed_mesh.h>
#include <isolux/mc_extract/iso_extractor.h>
#include <isolux/mc_extract/iso_mesh.h>
#include <isolux/mc_extract/large_vector.h>
#include <isolux/mc_extract/left_out_components.h>
#include <isolux/mc_extract/measure_mesh.h>
#include <isolux/mc_extract/vertex_resolution.h>
#include <isolux/mc_extract/write_mesh.h>
