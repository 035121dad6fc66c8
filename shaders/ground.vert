#version 330 core
#define LIGHT_OUT
#include "common.glsl"
#include "light.glsl"
layout(location = 0) in vec2 place;  // x, z [m]
out vec3 to_eye;                     // [m]
out vec2 on_grid;                    // in cells
out vec3 in_shadow;
out vec2 on_contact;
flat out vec4 paint;                 // a: with a grid
flat out vec4 lines;
void main() {
  vec3 world = vec3(place.x, ground.x, place.y);
  to_eye = eye.xyz - world;
  on_grid = place / ground.y;
  in_shadow = in_shadow_map(world, vec3(0.0, 1.0, 0.0));
  on_contact = in_contact_map(world);
  paint = vec4(ground_colour.rgb, ground.z);
  lines = grid_colour;
  hand_light();
  gl_Position = clip_from_world * vec4(world, 1.0);
}
