#version 330 core

layout(location = 0) in vec3 position;  // world
layout(location = 1) in vec3 normal;    // world
layout(location = 2) in vec3 extra;     // e where it was traced here, or what is added to what is read

uniform vec3 centre;              // world; what follows is relative to it, so that far origins lose no bits,
uniform float scale;              // and in units that suit the box, for squares of world lengths may be beyond floats
uniform mat4 clip_from_centred;
uniform mat3 place_from_centred;  // to the place in the volume's box, whose middle is the centre

out vec3 centred;
out vec3 outward;
centroid out vec3 place;
centroid out vec3 at_vertices;

void main() {
  centred = scale * (position - centre);
  outward = normal;
  at_vertices = extra;
  place = place_from_centred * centred + 0.5;
  gl_Position = clip_from_centred * vec4(centred, 1.0);
}
