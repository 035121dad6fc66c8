#version 330 core
// The ground where something may shade it.
#include "light.glsl"
#include "grid.glsl"
#include "colour.glsl"
#include "shading.glsl"
in vec3 to_eye;
in vec2 on_grid;  // in cells
in vec3 in_shadow;
in vec2 on_contact;
flat in vec4 paint;  // a: with a grid
flat in vec4 lines;
out vec4 picture_out;

void main() {
  float d = length(to_eye);
  vec3 base = paint.rgb;
  if (paint.a > 0.5) {
    base = mix(base, lines.rgb, lines_cover(on_grid, lines.a));
  }
  float lit = to_sun.y * sun_visibility(in_shadow);
  float shade = contact_shade(on_contact, 1.0, 1.0);
  float e1 = 1.0 - max(to_eye.y / d, 0.0), e2 = e1 * e1;
  vec3 radiance = base * (max(lit, 0.0) * sun_colour.rgb + sky_light(1.0) * shade) +
                  0.25 * e2 * e2 * e1 * horizon.rgb * shade;
  picture_out = vec4(with_haze(picture_colour(radiance), d), 1.0);
}
