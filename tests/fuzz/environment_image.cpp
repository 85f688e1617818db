// Pictures of environments; the input's first bytes say of which kind, as names do.
#include <isolux/bake/scene_file.h>

#include "fuzz.h"
#include "support.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace isolux;
  static const test::TemporaryFolder folder;
  const std::string bytes = fuzz::text_of(data, size);
  const std::string path = folder.write(bytes.starts_with("\x76\x2f\x31\x01") ? "a.exr" : "a.hdr", bytes);
  ImageEnvironment image;
  if (fuzz::refused([&] { image = read_environment_image(path); })) return 0;
  fuzz::require(image.width >= 1 && image.height >= 1, "a picture has pixels");
  fuzz::require(image.pixels.size() == std::size_t(image.width) * std::size_t(image.height), "all pixels are there");
  (void)environment_radiance(image, Vec3(0.0, 0.6, 0.8));
  return 0;
}
