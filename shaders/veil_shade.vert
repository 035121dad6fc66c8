#version 330 core
// One triangle over the whole target. Along the ray through a pixel everything is linear in its
// distance: what the fragment shader multiplies by that is computed here.
#define LIGHT_OUT
#include "common.glsl"
#include "light.glsl"
#include "soft.glsl"
out vec3 ray;                     // by [m] along the line of sight of the picture's middle
out vec3 ray_in_veil, ray_in_shadow;
flat out vec4 eye_in_veil;        // a: 1 / softness of the veil's front
flat out vec4 eye_in_shadow;
flat out vec4 step_x, step_y, step_z;  // in the shadow map, along the normal; near, far, scale
void main() {
  vec2 s = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2)) * 2.0 - 1.0;
  ray = view_forward.xyz + s.x * view_right.xyz + s.y * view_up.xyz;
  ray_in_veil = mat3(veil_from_world) * ray;
  ray_in_shadow = mat3(shadow_from_world) * ray;
  eye_in_veil = vec4((veil_from_world * vec4(eye.xyz, 1.0)).xyz, veil.x);
  eye_in_shadow = vec4(in_shadow_map(eye.xyz, vec3(0.0)), 0.0);
  mat3 turn = shadow_look.y * transpose(mat3(shadow_from_world));
  step_x = vec4(turn[0], depths.x);
  step_y = vec4(turn[1], depths.y);
  step_z = vec4(turn[2], veil.y);
  hand_light();
  gl_Position = vec4(s, 1.0, 1.0);
}
