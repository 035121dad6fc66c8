#version 330 core
#include "common.glsl"
in vec2 uv;
out vec4 picture_out;
void main() {
  vec2 s = 2.0 * uv - 1.0;
  vec3 d = normalize(view_forward.xyz + s.x * view_right.xyz + s.y * view_up.xyz);
  picture_out = vec4(sky_colour(d), 1.0);
}
