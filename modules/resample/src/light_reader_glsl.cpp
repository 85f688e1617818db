#include <fmt/format.h>
#include <isolux/resample/light_reader.h>

namespace isolux {
namespace {

constexpr const char* kTexels = R"(
uniform vec3 light_scale;           // texture coordinate of V, S and B = scale * place + offset
uniform vec3 light_offset;
uniform sampler3D light_pages;      // where in the atlas a brick is, in 1/1023; alpha is 0 where there is none
uniform vec3 light_texels;          // of the whole light
uniform vec3 light_page_count;
uniform vec3 atlas_texels;

// Where the light's textures hold a place; false where there is no brick.
bool find_texel(vec3 place, out vec3 coordinate) {
  coordinate = light_scale * place + light_offset;
  if (!light_in_bricks) return true;
  vec3 texel = clamp(coordinate * light_texels - 0.5, vec3(0.0), light_texels - 1.0);
  vec3 page = floor(0.25 * min(texel, max(light_texels - 2.0, 0.0)));
  vec4 brick = texture(light_pages, (page + 0.5) / light_page_count);
  coordinate = (5.0 * 1023.0 * brick.xyz + (texel - 4.0 * page) + 0.5) / atlas_texels;
  return brick.a > 0.0;
}
)";

constexpr const char* kVolume = R"(
uniform sampler3D volume_values;    // f, texels at the grid points
uniform float volume_gain;          // what f is to be multiplied with
uniform vec3 grid_points;           // of the volume
uniform mat3 index_from_spacings;   // directions, from world ones in mean spacings: world units may be of any size

float volume_at(vec3 index) { return volume_gain * texture(volume_values, (index + 0.5) / grid_points).r; }

// Equal to interpolating the grid points' central differences, but on the outermost grid points.
vec3 index_gradient(vec3 index) {
  vec3 g;
  g.x = volume_at(index + vec3(1, 0, 0)) - volume_at(index - vec3(1, 0, 0));
  g.y = volume_at(index + vec3(0, 1, 0)) - volume_at(index - vec3(0, 1, 0));
  g.z = volume_at(index + vec3(0, 0, 1)) - volume_at(index - vec3(0, 0, 1));
  return 0.5 * g;
}
)";

constexpr const char* kNearField = R"(
uniform float near_field_step[near_field_terms];
uniform float near_field_mean[near_field_terms];
uniform vec3 near_field_weight[near_field_terms];

vec3 near_field(vec3 index, float isovalue, vec3 downhill, vec2 steepness) {
  vec3 e = vec3(0.0);
  vec3 ahead = index_from_spacings * downhill;
  for (int t = 0; t < near_field_terms; ++t) {
    float fall = isovalue - volume_at(index + near_field_step[t] * ahead);
    float slope = fall / steepness.x / (near_field_step[t] * steepness.y);
    float openness = steepness.x > 0.0 ? clamp(slope, -1.0, 1.0) : 0.0;
    e += near_field_weight[t] * (openness - near_field_mean[t]);
  }
  return e;
}
)";

constexpr const char* kNoNearField = R"(
vec3 near_field(vec3 index, float isovalue, vec3 downhill, vec2 steepness) { return vec3(0.0); }
)";

constexpr const char* kNormals = R"(
uniform sampler3D light_normals_x;  // B
uniform sampler3D light_normals_y;
uniform sampler3D light_normals_z;
uniform vec3 light_normals_gain;    // what each is to be multiplied with

vec3 by_normal(vec3 place, vec3 downhill) {
  vec3 coordinate;
  if (!find_texel(place, coordinate)) return vec3(0.0);
  vec3 n = light_normals_gain * downhill;
  return n.x * texture(light_normals_x, coordinate).rgb + n.y * texture(light_normals_y, coordinate).rgb +
         n.z * texture(light_normals_z, coordinate).rgb;
}
)";

constexpr const char* kNoNormals = R"(
vec3 by_normal(vec3 place, vec3 downhill) { return vec3(0.0); }
)";

constexpr const char* kAtVertices = R"(
vec3 light_at_vertices(vec3 place, float isovalue) {
  vec3 index = place * (grid_points - 1.0);
  vec3 gradient = index_gradient(index);
  // The gradient's length as a product: floats hold no squares of small or large values.
  float largest = max(max(abs(gradient.x), abs(gradient.y)), abs(gradient.z));
  vec3 uphill = largest > 0.0 ? transpose(index_from_spacings) * (gradient / largest) : vec3(0.0);
  vec2 steepness = vec2(largest, length(uphill));
  vec3 downhill = largest > 0.0 ? -uphill / steepness.y : vec3(0.0);
  return near_field(index, isovalue, downhill, steepness) + by_normal(place, downhill);
}
)";

constexpr const char* kReader = R"(
uniform sampler3D light_offsets;    // V; of bricks, their atlas
uniform float light_gain;           // what V is to be multiplied with
uniform sampler3D light_slopes;     // S, likewise
uniform float light_slope_gain;
uniform float reference_isovalue;   // h0
uniform float light_ceiling;

vec3 read_light(vec3 place, float isovalue, vec3 at_vertices) {
  vec3 coordinate;
  if (!find_texel(place, coordinate)) return vec3(0.0);
  vec3 e = light_gain * texture(light_offsets, coordinate).rgb;
  if (!light_has_slopes && !light_at_vertices) return e;
  if (light_has_slopes) e += texture(light_slopes, coordinate).rgb * (light_slope_gain * (isovalue - reference_isovalue));
  if (light_at_vertices) e += at_vertices;
  return clamp(e, 0.0, light_ceiling);
}
)";

}  // namespace

std::string light_reader_glsl(const LightShader& kind) {
  return fmt::format(
      "#version 330 core\n"
      "const bool light_has_slopes = {};\n"
      "const bool light_in_bricks = {};\n"
      "const bool light_at_vertices = {};\n{}{}",
      kind.slopes, kind.bricks, kind.at_vertices(), kTexels, kReader);
}

std::string light_at_vertices_glsl(const LightShader& kind) {
  return fmt::format(
      "#version 330 core\n"
      "const bool light_in_bricks = {};\n"
      "const int near_field_terms = {};\n{}{}{}{}{}",
      kind.bricks, kind.near_field_terms, kTexels, kVolume, kind.near_field_terms > 0 ? kNearField : kNoNearField,
      kind.normals ? kNormals : kNoNormals, kAtVertices);
}

}  // namespace isolux
