// Comes after #version and the constants flat_colour (for lines), global_light, exact_light (traced at the vertices,
// instead of read from the texture) and inner_light (of back faces, which read_light() gives); see SurfaceRenderer.
in vec3 centred;
in vec3 outward;
centroid in vec3 place;  // pixels that a triangle covers in part must not look beyond it: there may be no texels
centroid in vec3 at_vertices;  // exact light, or what is added at the vertices

uniform vec3 eye;       // relative to the centre, in the vertices' units
uniform vec3 albedo;
uniform vec3 emission;
uniform float exposure;
uniform float isovalue;
uniform vec3 line_colour;

out vec4 colour;

vec3 read_light(vec3 place, float isovalue, vec3 at_vertices);  // light_reader_glsl()

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
    radiance = albedo * (exact_light ? at_vertices : read_light(place, isovalue, at_vertices)) + emission;
  } else if (inner_light) {
    radiance = albedo * read_light(place, isovalue, at_vertices) + emission;
  } else {
    radiance = albedo * 0.1 * local_light(-n);  // the inner side has no light of its own
  }
  colour = vec4(srgb(exposure * radiance), 1.0);
}
