// The front page of core: value types, errors, options, registry, random numbers and the parallel loop.
// Depends on no other module of isolux.
#pragma once

#include <isolux/core/error.h>
#include <isolux/core/field.h>
#include <isolux/core/field_points.h>
#include <isolux/core/grid.h>
#include <isolux/core/illumination_grid.h>
#include <isolux/core/lattice.h>
#include <isolux/core/light_bricks.h>
#include <isolux/core/options.h>
#include <isolux/core/parallel.h>
#include <isolux/core/quantile.h>
#include <isolux/core/random.h>
#include <isolux/core/registry.h>
#include <isolux/core/release.h>
#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/spread_labels.h>
#include <isolux/core/stopwatch.h>
#include <isolux/core/surface_colour.h>
#include <isolux/core/texel_mask.h>
#include <isolux/core/vec.h>
#include <isolux/core/volume.h>
