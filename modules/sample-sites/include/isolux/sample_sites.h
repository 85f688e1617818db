// The front page of sample-sites: where in the volume light is sampled.
#pragma once

#include <isolux/core/error.h>
#include <isolux/sample_sites/site_sampler.h>
