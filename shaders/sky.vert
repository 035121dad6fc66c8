#version 330 core
#include "frame.glsl"
out vec3 direction;
flat out vec4 v_zenith, v_horizon, v_sun, v_to_sun;  // flat as in light.glsl
void main() {
  vec2 s = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2)) * 2.0 - 1.0;
  direction = view_forward.xyz + s.x * view_right.xyz + s.y * view_up.xyz;
  v_zenith = sky_zenith;
  v_horizon = sky_horizon;
  v_sun = sun_colour;
  v_to_sun = to_sun;
  gl_Position = vec4(s, 1.0, 1.0);
}
