#version 330 core

layout(location = 0) in vec3 position;  // world

uniform vec3 centre;
uniform mat3 place_from_centred;

out vec3 gradient;  // of the volume, world

vec3 volume_gradient(vec3 place);  // volume_gradient_glsl()

void main() {
  gradient = volume_gradient(place_from_centred * (position - centre) + 0.5);
}
