#include <isolux/resample/light_reader.h>

namespace isolux {

const char* light_reader_glsl() {
  return R"(#version 330 core

uniform sampler3D light_offsets;    // V
uniform float light_gain;           // what V is to be multiplied with
uniform vec3 light_scale;           // texture coordinate of V and S = scale * place + offset
uniform vec3 light_offset;
uniform bool light_has_slopes;
uniform sampler3D light_slopes;     // S
uniform float reference_isovalue;   // h0
uniform float light_ceiling;
uniform sampler3D volume_values;    // f, texels at the grid points
uniform vec3 grid_points;           // of the volume
uniform mat3 index_from_world;      // directions
uniform float mean_spacing;
uniform int near_field_terms;       // at most 4; without any, f is not read
uniform float near_field_step[4];
uniform float near_field_mean[4];
uniform vec3 near_field_weight[4];

float volume_at(vec3 index) { return texture(volume_values, (index + 0.5) / grid_points).r; }

vec3 volume_gradient(vec3 index) {
  // Equal to interpolating the grid points' central differences, but on the outermost grid points.
  vec3 g;
  g.x = volume_at(index + vec3(1, 0, 0)) - volume_at(index - vec3(1, 0, 0));
  g.y = volume_at(index + vec3(0, 1, 0)) - volume_at(index - vec3(0, 1, 0));
  g.z = volume_at(index + vec3(0, 0, 1)) - volume_at(index - vec3(0, 0, 1));
  return 0.5 * transpose(index_from_world) * g;
}

vec3 near_field(vec3 index, float isovalue) {
  vec3 e = vec3(0.0);
  vec3 gradient = volume_gradient(index);
  float steepness = length(gradient);
  for (int t = 0; t < near_field_terms; ++t) {
    float reach = near_field_step[t] * mean_spacing;
    float openness = 0.0;
    if (steepness > 0.0) {
      vec3 ahead = index - index_from_world * (gradient * (reach / steepness));
      openness = clamp((isovalue - volume_at(ahead)) / (steepness * reach), -1.0, 1.0);
    }
    e += near_field_weight[t] * (openness - near_field_mean[t]);
  }
  return e;
}

vec3 read_light(vec3 place, float isovalue) {
  vec3 coordinate = light_scale * place + light_offset;
  vec3 e = light_gain * texture(light_offsets, coordinate).rgb;
  if (!light_has_slopes && near_field_terms == 0) return e;
  if (light_has_slopes) e += texture(light_slopes, coordinate).rgb * (isovalue - reference_isovalue);
  if (near_field_terms > 0) e += near_field(place * (grid_points - 1.0), isovalue);
  return clamp(e, 0.0, light_ceiling);
}
)";
}

}  // namespace isolux
