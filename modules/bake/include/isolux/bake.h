// The front page of bake: sites, trace and resample composed into one call, through the registries.
#pragma once

#include <isolux/bake/bake.h>
#include <isolux/bake/choose_texels.h>
#include <isolux/bake/find_sites.h>
#include <isolux/bake/kept_rays.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/bake/light_on_box.h>
#include <isolux/bake/light_points.h>
#include <isolux/bake/memory_foreseen.h>
#include <isolux/bake/scene_file.h>
#include <isolux/bake/stages.h>
#include <isolux/bake/version.h>
#include <isolux/core/error.h>
