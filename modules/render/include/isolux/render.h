// The front page of render: pictures of lit isosurfaces without a display or a GPU.
#pragma once

#include <isolux/core/error.h>
#include <isolux/render/camera.h>
#include <isolux/render/image.h>
#include <isolux/render/render.h>
