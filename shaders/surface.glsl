#include "lighting.glsl"
#include "pattern.glsl"
in vec3 world;
centroid in vec3 world_normal;
in vec3 body;
flat in vec4 v_colour;
flat in vec4 v_look;
flat in vec4 v_pattern;
out vec4 picture_out;

void main() {
  vec3 n = normalize(gl_FrontFacing ? world_normal : -world_normal);
  vec3 base = v_colour.rgb;
  if (v_pattern.x > 0.5) base *= pattern_tone(body, v_pattern);
  picture_out = vec4(lit_picture_colour(world, n, base, v_look.xyz), v_colour.a);
}
