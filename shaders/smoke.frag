#version 330 core
// A soft puff that faces the eye: its picture says how dense it is and which way it bulges.
#include "common.glsl"
#include "soft.glsl"
uniform sampler2D puffs;  // bulge -1..1 in 0..1, density
uniform sampler2D scene_depth;
in vec2 on_puff;
in vec2 on_card;
flat in vec3 lit, shaded;
flat in vec3 sun_in_puff;
flat in vec2 opacity_radius;
in float z;
out vec4 picture_out;

void main() {
  vec4 puff = texture(puffs, on_puff);
  // It has a thickness: less of it is seen the less of that is in front of what is solid.
  float wall = distance_of(texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r);
  float thick = opacity_radius.y * sqrt(max(1.0 - dot(on_card, on_card), 0.0)) + 1e-5;
  float seen = clamp((wall - z + thick) / (2.0 * thick), 0.0, 1.0);
  // Nor does it slap into the eye.
  float near_fade = clamp((z - depths.x) / opacity_radius.y, 0.0, 1.0);
  float alpha = opacity_radius.x * puff.a * seen * near_fade;
  if (alpha < 0.002) discard;
  float side = dot(puff.xyz * 2.0 - 1.0, sun_in_puff);
  vec3 c = mix(shaded, lit, clamp(0.55 + 0.55 * side, 0.0, 1.0));
  picture_out = vec4(c * alpha, alpha);
}
