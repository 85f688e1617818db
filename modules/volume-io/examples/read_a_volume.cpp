#include <isolux/core/error.h>
#include <isolux/volume_io.h>

#include <cstdio>

// Reads a volume (a file, a folder of DICOM slices, or gen:NAME:N) and prints its size and range.
int main(int argc, char** argv) try {
  const isolux::Volume volume = isolux::read_volume(argc > 1 ? argv[1] : "gen:gyroid:32");
  const isolux::Index3 size = volume.lattice().size;
  const isolux::ValueRange range = isolux::value_range(volume);
  std::printf("%s: %dx%dx%d, values %g to %g\n", volume.name.c_str(), size.x, size.y, size.z, double(range.low),
              double(range.high));
} catch (const isolux::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
