#include <fmt/format.h>
#include <isolux/resample/light_reader.h>

namespace isolux {
namespace {

constexpr const char* kNearField = R"(
uniform sampler3D volume_values;    // f, texels at the grid points
uniform vec3 grid_points;           // of the volume
uniform mat3 index_from_world;      // directions
uniform float mean_spacing;
uniform float near_field_step[near_field_terms];
uniform float near_field_mean[near_field_terms];
uniform vec3 near_field_weight[near_field_terms];

float volume_at(vec3 index) { return texture(volume_values, (index + 0.5) / grid_points).r; }

// Equal to interpolating the grid points' central differences, but on the outermost grid points.
vec3 world_gradient(vec3 index) {
  vec3 g;
  g.x = volume_at(index + vec3(1, 0, 0)) - volume_at(index - vec3(1, 0, 0));
  g.y = volume_at(index + vec3(0, 1, 0)) - volume_at(index - vec3(0, 1, 0));
  g.z = volume_at(index + vec3(0, 0, 1)) - volume_at(index - vec3(0, 0, 1));
  return 0.5 * transpose(index_from_world) * g;
}

vec3 near_field(vec3 place, float isovalue) {
  vec3 index = place * (grid_points - 1.0);
  vec3 gradient = world_gradient(index);
  vec3 e = vec3(0.0);
  float square = dot(gradient, gradient);
  float flatness = square > 0.0 ? inversesqrt(square) : 0.0;
  vec3 ahead = index_from_world * (gradient * (-mean_spacing * flatness));
  for (int t = 0; t < near_field_terms; ++t) {
    float fall = isovalue - volume_at(index + near_field_step[t] * ahead);
    float openness = clamp(fall * (flatness / (near_field_step[t] * mean_spacing)), -1.0, 1.0);
    e += near_field_weight[t] * (openness - near_field_mean[t]);
  }
  return e;
}
)";

constexpr const char* kReader = R"(
uniform sampler3D light_offsets;    // V; of bricks, their atlas
uniform float light_gain;           // what V is to be multiplied with
uniform vec3 light_scale;           // texture coordinate of V and S = scale * place + offset
uniform vec3 light_offset;
uniform sampler3D light_slopes;     // S, likewise
uniform float light_slope_gain;
uniform sampler3D light_pages;      // where in the atlas a brick is, in 1/1023; alpha is 0 where there is none
uniform vec3 light_texels;          // of the whole light
uniform vec3 light_page_count;
uniform vec3 atlas_texels;
uniform float reference_isovalue;   // h0
uniform float light_ceiling;

// From a coordinate in the whole light to one in the atlas; false where there is no brick.
bool find_brick(inout vec3 coordinate) {
  vec3 texel = clamp(coordinate * light_texels - 0.5, vec3(0.0), light_texels - 1.0);
  vec3 page = floor(0.25 * min(texel, max(light_texels - 2.0, 0.0)));
  vec4 brick = texture(light_pages, (page + 0.5) / light_page_count);
  coordinate = (5.0 * 1023.0 * brick.xyz + (texel - 4.0 * page) + 0.5) / atlas_texels;
  return brick.a > 0.0;
}

vec3 read_light(vec3 place, float isovalue, vec3 near_field) {
  vec3 coordinate = light_scale * place + light_offset;
  if (light_in_bricks && !find_brick(coordinate)) return vec3(0.0);
  vec3 e = light_gain * texture(light_offsets, coordinate).rgb;
  if (!light_has_slopes && !light_has_near_field) return e;
  if (light_has_slopes) e += texture(light_slopes, coordinate).rgb * (light_slope_gain * (isovalue - reference_isovalue));
  if (light_has_near_field) e += near_field;
  return clamp(e, 0.0, light_ceiling);
}
)";

}  // namespace

std::string light_reader_glsl(const LightShader& kind) {
  return fmt::format(
      "#version 330 core\n"
      "const bool light_has_slopes = {};\n"
      "const bool light_in_bricks = {};\n"
      "const bool light_has_near_field = {};\n{}",
      kind.slopes, kind.bricks, kind.near_field_terms > 0, kReader);
}

std::string near_field_glsl(int terms) {
  return fmt::format("#version 330 core\nconst int near_field_terms = {};\n{}", terms, kNearField);
}

}  // namespace isolux
