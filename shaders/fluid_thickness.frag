#version 330 core
// How much liquid there is behind a pixel before what is solid, how much foam at its front, and how
// much liquid as if nothing solid were there.
// Drawn at half the picture's size, and summed.
#include "common.glsl"
#include "soft.glsl"
uniform sampler2D scene_depth;
uniform sampler2D front;  // smooth distance of the surface
in vec3 on_card;
flat in vec4 v_sphere;
flat in float v_foam;
out vec4 picture_out;

void main() {
  vec3 ray = normalize(on_card - eye.xyz);
  vec3 from_centre = eye.xyz - v_sphere.xyz;
  vec3 nearest = from_centre - dot(from_centre, ray) * ray;
  float miss2 = dot(nearest, nearest), r2 = v_sphere.w * v_sphere.w;
  if (miss2 > r2) discard;
  float half_chord = sqrt(r2 - miss2);
  float middle = dot(v_sphere.xyz + nearest - eye.xyz, view_forward.xyz);
  ivec2 at = min(ivec2(2.0 * gl_FragCoord.xy), textureSize(scene_depth, 0) - 1);
  float wall = distance_of(texelFetch(scene_depth, at, 0).r);
  float chord = clamp(wall - middle + half_chord, 0.0, 2.0 * half_chord);
  float behind = max(middle - texelFetch(front, at, 0).r, 0.0);
  float some = chord * absorb.w;
  picture_out = vec4(some, v_foam * some * exp(-behind / (2.0 * v_sphere.w)),
                     2.0 * half_chord * absorb.w, 0.0);
}
