#version 330 core
#define LIGHT_OUT
#include "common.glsl"
#include "light.glsl"
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 row0;  // world from mesh
layout(location = 3) in vec4 row1;
layout(location = 4) in vec4 row2;
layout(location = 5) in vec4 colour;   // linear, opacity
layout(location = 6) in vec4 look;     // roughness, metallic, emission, inflate [m]
layout(location = 7) in vec4 pattern;  // kind, strength, size [m], shift [m]

out vec3 to_eye;  // [m]
centroid out vec3 world_normal;
out vec3 body;  // body coordinates [m]
// In the shadow map, and from there along the normal to where it is looked up; in the contact map,
// and lowness.
out vec3 in_shadow, on_ground;
centroid out vec3 shadow_step;
flat out vec4 v_colour;
flat out vec4 v_look;
flat out vec4 v_pattern;

void main() {
  vec3 c0 = vec3(row0.x, row1.x, row2.x), c1 = vec3(row0.y, row1.y, row2.y),
       c2 = vec3(row0.z, row1.z, row2.z);
  vec3 scale2 = vec3(dot(c0, c0), dot(c1, c1), dot(c2, c2));
  vec3 scale = sqrt(scale2);
  // A scaled mesh bends its normals; an inflated core keeps them (builtin_meshes.hpp).
  vec3 n = look.w > 0.0 ? normal / scale : normal / scale2;
  n = normalize(c0 * n.x + c1 * n.y + c2 * n.z);
  vec3 world = c0 * position.x + c1 * position.y + c2 * position.z +
          vec3(row0.w, row1.w, row2.w) + n * look.w;
  to_eye = eye.xyz - world;
  in_shadow = in_shadow_map(world, vec3(0.0));
  shadow_step = in_shadow_map(world, n) - in_shadow;
  on_ground = vec3(in_contact_map(world), lowness(world.y));
  world_normal = n;
  body = position * scale + normal * look.w;
  hand_light();
  v_colour = colour;
  v_look = look;
  v_pattern = pattern;
  gl_Position = clip_from_world * vec4(world, 1.0);
}
