#include <isolux/gl_texture.h>

#include <cstdio>

namespace {

// Call it with an OpenGL context current; keep the texture while you draw.
isolux::Texture3D light_texture(const isolux::IlluminationGrid& light, const isolux::Lattice& volume) {
  const auto uploader = isolux::uploaders().create("whole", {{"format", "float16"}});
  return uploader->upload(light, volume);
}

}  // namespace

int main(int argc, char** /*argv*/) {
  const isolux::Lattice volume{.size = {64, 64, 64}, .frame = {}};
  const isolux::IlluminationGrid light(isolux::voxel_lattice(volume), 1);
  const isolux::TextureMapping mapping = isolux::texture_mapping(light.lattice, volume);
  std::printf("texture coordinate = %.6f * place + %.6f\n", mapping.scale.x, mapping.offset.x);
  if (argc > 1) std::printf("texture %u\n", light_texture(light, volume).name());
}
