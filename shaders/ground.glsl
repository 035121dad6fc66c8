// The ground. BARE: where nothing stands or casts a shadow.
#include "light.glsl"
#include "colour.glsl"
#include "shading.glsl"
in vec3 to_eye;
in vec2 on_grid;  // in cells
in vec3 in_shadow;
in vec2 on_contact;
flat in vec4 paint;  // a: with a grid
flat in vec4 lines;
out vec4 picture_out;

// Share of a pixel of width w that lines at whole numbers, `half_width` wide, cover: the exact
// box-filtered integral, so that far lines fade to their mean instead of flickering.
vec2 line_cover(vec2 p, vec2 w, float half_width) {
  vec2 a = p + 0.5 * w, b = p - 0.5 * w;
  vec2 fa = floor(a) + min(fract(a) / (2.0 * half_width), 1.0);
  vec2 fb = floor(b) + min(fract(b) / (2.0 * half_width), 1.0);
  return 2.0 * half_width * (fa - fb) / w;
}
// Lines are `half_width` cells wide, but never wider than three pixels.
float grid_cover(vec2 p, float half_width) {
  vec2 w = max(fwidth(p), 1e-5);
  float wide = min(half_width, 1.5 * max(w.x, w.y));
  vec2 c = clamp(line_cover(p + wide, w, wide), 0.0, 1.0);
  // Beyond half a cell a pixel the lines are one flat tone; let them go.
  c *= clamp(1.5 - 3.0 * w, 0.0, 1.0);
  return max(c.x, c.y);
}

void main() {
  float d = length(to_eye);
  vec3 base = paint.rgb;
  if (paint.a > 0.5) {
    float fine = 0.7 * lines.a * grid_cover(on_grid, 0.009);
    float coarse = (0.7 + 0.3 * lines.a) * grid_cover(0.1 * on_grid, 0.0018);
    base = mix(base, lines.rgb, max(fine, coarse));
  }
#ifdef BARE
  float lit = to_sun.y, shade = 1.0;
#else
  float lit = to_sun.y * sun_visibility(in_shadow);
  float shade = contact_shade(on_contact, 1.0, 1.0);
#endif
  float e1 = 1.0 - max(to_eye.y / d, 0.0), e2 = e1 * e1;
  vec3 radiance = base * (max(lit, 0.0) * sun_colour.rgb + sky_light(1.0) * shade) +
                  0.25 * e2 * e2 * e1 * horizon.rgb * shade;
  picture_out = vec4(with_haze(picture_colour(radiance), d), 1.0);
}
