#version 330 core

in vec3 centred;
in vec3 outward;
in vec3 place;
in vec3 exact;

uniform vec3 eye;       // relative to the centre
uniform vec3 albedo;
uniform float exposure;
uniform bool global_light;
uniform bool exact_light;  // traced at the vertices, instead of read from the texture
uniform bool inner_light;  // back faces have light of their own, which read_light() gives
uniform float isovalue;
uniform bool flat_colour;  // for lines
uniform vec3 line_colour;

out vec4 colour;

vec3 read_light(vec3 place, float isovalue);  // light_reader_glsl()

// A headlight over the viewer's shoulder and a hemisphere of sky above +z, as isolux render draws them.
float local_light(vec3 n) {
  float head = max(0.0, dot(n, normalize(eye - centred)));
  return 0.7 * head + 0.15 * (1.0 + n.z);
}

vec3 srgb(vec3 linear) {
  vec3 v = clamp(linear, 0.0, 1.0);
  return mix(1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, 12.92 * v, lessThanEqual(v, vec3(0.0031308)));
}

void main() {
  if (flat_colour) {
    colour = vec4(line_colour, 1.0);
    return;
  }
  vec3 n = outward * inversesqrt(max(dot(outward, outward), 1e-30));
  vec3 radiance;
  if (!global_light) {
    radiance = albedo * local_light(gl_FrontFacing ? n : -n);
  } else if (gl_FrontFacing) {
    radiance = albedo * (exact_light ? exact : read_light(place, isovalue));
  } else if (inner_light) {
    radiance = albedo * read_light(place, isovalue);
  } else {
    radiance = albedo * 0.1 * local_light(-n);  // the inner side has no light of its own
  }
  colour = vec4(srgb(exposure * radiance), 1.0);
}
