// Scenes in JSON. A picture lies beside them, `sky.hdr`.
#include <isolux/bake/scene_file.h>

#include <variant>

#include "fuzz.h"
#include "support.h"

namespace {

// Two equal pixels, not compressed.
const std::string kPicture = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x80\x80\x80\x80\x80\x80\x80";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace isolux;
  static const test::TemporaryFolder folder;
  static const std::string picture = folder.write("sky.hdr", kPicture);
  const std::string path = folder.write("scene.json", fuzz::text_of(data, size));
  Scene scene;
  if (fuzz::refused([&] { scene = read_scene(path); })) return 0;
  fuzz::require(!fuzz::refused([&] { require_valid(scene); }), "a scene that is taken is valid");
  (void)is_grey(scene);
  (void)has_lamps(scene);
  (void)scene.albedo.at(0.5f);
  (void)scene.emission.at(-1e30f);
  const std::string told = scene_to_json(scene);
  if (std::holds_alternative<ImageEnvironment>(scene.environment)) return 0;
  Scene again;
  fuzz::require(!fuzz::refused([&] { again = parse_scene(told, folder.file(""), "told"); }), "a scene told is taken");
  fuzz::require(scene_to_json(again) == told, "a scene told is the scene");
  return 0;
}
