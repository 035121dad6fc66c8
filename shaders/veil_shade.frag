#version 330 core
// The shade of liquids and smoke on what has been drawn: a factor of its colour.
#include "common.glsl"
#include "shading.glsl"
#include "soft.glsl"
uniform sampler2D scene_depth;
uniform sampler2D sun_veil;
in vec2 uv;
out vec4 picture_out;

void main() {
  float depth = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
  vec3 at = point_at(2.0 * uv - 1.0, distance_of(depth));
  vec3 across = cross(dFdx(at), dFdy(at));
  vec3 in_veil = (veil_from_world * vec4(at, 1.0)).xyz;
  picture_out = vec4(1.0);
  if (depth >= 1.0 || any(lessThan(in_veil.xy, vec2(0.0))) || any(greaterThan(in_veil.xy, vec2(1.0))))
    return;
  vec4 left = texture(sun_veil, in_veil.xy);
  float behind = clamp((in_veil.z - left.a) * veil.x, 0.0, 1.0);
  float size = length(across);
  vec3 n = size > 0.0 ? across / size : vec3(0.0, 1.0, 0.0);
  float sun = max(dot(n, to_sun.xyz), 0.0) * dot(sun_colour.rgb, vec3(0.333)) *
              sun_visibility_cheap(in_shadow_map(at, n));
  float share = sun / (sun + dot(sky_light(n.y), vec3(0.333)) + 1e-4);
  picture_out.rgb = srgb_from_linear(1.0 - behind * share * (1.0 - left.rgb));
}
