#version 330 core
// The ground where nothing stands or casts a shadow: its light changes with nothing but the sky's
// mirror at grazing angles, so colours are those of three such angles, by a parabola.
#include "common.glsl"
layout(location = 0) in vec2 place;  // x, z [m]
out vec3 to_eye;                     // [m]
out vec2 on_grid;                    // in cells
flat out vec3 of_ground[3], of_line[3];  // powers of what is mirrored
flat out vec4 v_haze;                // sRGB; rate [1/m]
flat out vec2 grid;                  // there is one; strength of its fine lines

void parabola(vec3 base, out vec3 c[3]) {
  vec3 lit = base * (max(to_sun.y, 0.0) * sun_colour.rgb + sky_light(1.0));
  vec3 mirrored = 0.25 * horizon.rgb;
  vec3 none = picture_colour(lit), some = picture_colour(lit + 0.5 * mirrored), all = picture_colour(lit + mirrored);
  c[0] = none;
  c[2] = 2.0 * (none - 2.0 * some + all);
  c[1] = all - none - c[2];
}

void main() {
  vec3 world = vec3(place.x, ground.x, place.y);
  to_eye = eye.xyz - world;
  on_grid = place / ground.y;
  parabola(ground_colour.rgb, of_ground);
  parabola(grid_colour.rgb, of_line);
  v_haze = vec4(haze.rgb, haze_rate);
  grid = vec2(ground.z, grid_colour.a);
  gl_Position = clip_from_world * vec4(world, 1.0);
}
