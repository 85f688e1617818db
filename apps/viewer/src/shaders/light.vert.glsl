#version 330 core

layout(location = 0) in vec3 position;  // world

uniform vec3 centre;
uniform float scale;
uniform mat3 place_from_centred;
uniform float isovalue;

out vec3 at_vertex;  // near field and normal: what is added to e

vec3 light_at_vertices(vec3 place, float isovalue);  // light_at_vertices_glsl()

void main() {
  at_vertex = light_at_vertices(place_from_centred * (scale * (position - centre)) + 0.5, isovalue);
}
