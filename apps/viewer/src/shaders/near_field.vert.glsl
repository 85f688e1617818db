#version 330 core

layout(location = 0) in vec3 position;  // world

uniform vec3 centre;
uniform mat3 place_from_centred;
uniform float isovalue;

out vec3 at_vertex;  // what the near field adds to e

vec3 near_field(vec3 place, float isovalue);  // near_field_glsl()

void main() {
  at_vertex = near_field(place_from_centred * (position - centre) + 0.5, isovalue);
}
