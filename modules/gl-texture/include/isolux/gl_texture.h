// The front page of gl-texture: the illumination grid as an OpenGL 3D texture.
#pragma once

#include <isolux/core/error.h>
#include <isolux/gl_texture/brick_textures.h>
#include <isolux/gl_texture/texture3d.h>
#include <isolux/gl_texture/texture_mapping.h>
#include <isolux/gl_texture/texture_uploader.h>
