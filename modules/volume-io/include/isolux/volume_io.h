// The front page of volume-io: volumes and light from and to files.
#pragma once

#include <isolux/core/error.h>
#include <isolux/core/registry.h>
#include <isolux/volume_io/analytic_fields.h>
#include <isolux/volume_io/atomic_file.h>
#include <isolux/volume_io/light_file.h>
#include <isolux/volume_io/read.h>
#include <isolux/volume_io/scalar_type.h>
#include <isolux/volume_io/volume_reader.h>
#include <isolux/volume_io/write.h>
