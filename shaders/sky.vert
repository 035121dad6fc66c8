#version 330 core
// The sky is smooth: its colours are those of the corners of a grid over the picture. Two triangles a
// cell, by number (background.hpp).
#include "sky_grid.glsl"
#include "frame.glsl"
#include "srgb.glsl"
#include "sky.glsl"
out vec3 colour;
out float above;  // the horizon
flat out vec3 at_horizon;
void main() {
  int cell = gl_VertexID / 6, corner = gl_VertexID % 6;
  ivec2 at = ivec2(cell % SKY_COLUMNS, cell / SKY_COLUMNS) +
             ivec2(corner == 1 || corner == 3 || corner == 4, corner == 2 || corner == 4 || corner == 5);
  vec2 s = 2.0 * vec2(at) / vec2(SKY_COLUMNS, SKY_ROWS) - 1.0;
  vec3 direction = view_forward.xyz + s.x * view_right.xyz + s.y * view_up.xyz;
  above = direction.y;
  colour = sky_colour_beyond(normalize(direction));
  at_horizon = srgb_from_linear(clamp(sky_horizon.rgb, 0.0, 1.0));
  gl_Position = vec4(s, 1.0, 1.0);
}
