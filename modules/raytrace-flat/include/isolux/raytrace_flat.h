// The front page of raytrace-flat: light carried by rays that never leave their level set.
#pragma once

#include <isolux/core/error.h>
#include <isolux/raytrace_flat/flat_tracer.h>
#include <isolux/raytrace_flat/gather.h>
#include <isolux/raytrace_flat/level_set_intersector.h>
#include <isolux/raytrace_flat/light_links.h>
#include <isolux/raytrace_flat/scene.h>
#include <isolux/raytrace_flat/trace_counters.h>
