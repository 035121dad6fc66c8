#include "light.glsl"
#include "colour.glsl"
#include "lighting.glsl"
#include "pattern.glsl"
in vec3 to_eye;
centroid in vec3 world_normal;
in vec3 body;
in vec3 in_shadow, on_ground;
centroid in vec3 shadow_step;
flat in vec4 v_colour;
flat in vec4 v_look;
flat in vec4 v_pattern;
out vec4 picture_out;

void main() {
  float unit = inversesqrt(max(dot(world_normal, world_normal), 1e-12)) * (gl_FrontFacing ? 1.0 : -1.0);
  vec3 n = unit * world_normal;
  vec3 base = v_colour.rgb;
#ifdef PATTERNED
  if (v_pattern.x > 0.5) base *= pattern_tone(body, v_pattern);
#endif
  Place place = Place(to_eye, in_shadow + unit * shadow_step, on_ground);
#ifdef GLASS
  picture_out = lit_glass(place, n, base, v_colour.a, v_look.xyz);
#else
  picture_out = vec4(lit_picture_colour(place, n, base, v_look.xyz), v_colour.a);
#endif
}
