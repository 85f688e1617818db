// The front page of resample: scattered radiance samples become the illumination grid.
#pragma once

#include <isolux/core/error.h>
#include <isolux/resample/fill_unlit.h>
#include <isolux/resample/light_bricks.h>
#include <isolux/resample/light_reader.h>
#include <isolux/resample/openness.h>
#include <isolux/resample/resampler.h>
#include <isolux/resample/texel_means.h>
