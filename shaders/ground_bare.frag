#version 330 core
#include "grid.glsl"
in vec3 to_eye;
in vec2 on_grid;  // in cells
flat in vec3 of_ground[3], of_line[3];
flat in vec4 v_haze;
flat in vec2 grid;
out vec4 picture_out;
void main() {
  float d2 = dot(to_eye, to_eye);
  float e1 = 1.0 - max(to_eye.y * inversesqrt(d2), 0.0), e2 = e1 * e1;
  float mirrored = e2 * e2 * e1;
  vec3 c = of_ground[0] + mirrored * (of_ground[1] + mirrored * of_ground[2]);
  if (grid.x > 0.5) {
    vec3 line = of_line[0] + mirrored * (of_line[1] + mirrored * of_line[2]);
    c = mix(c, line, lines_cover(on_grid, grid.y));
  }
  picture_out = vec4(mix(v_haze.rgb, c, 1.0 / (1.0 + v_haze.w * v_haze.w * d2)), 1.0);
}
