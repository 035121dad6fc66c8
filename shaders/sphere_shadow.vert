#version 330 core
#include "common.glsl"
layout(location = 0) in vec4 sphere;  // centre, radius [m]
out vec2 from_centre;                 // in radii

// A disc through the centre that faces the sun: the exact shadow, and it cannot reach the lit half
// of its own sphere.
void main() {
  vec3 side = normalize(cross(to_sun.xyz, abs(to_sun.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0)));
  int corner = gl_VertexID % 3;
  from_centre = corner == 0 ? vec2(0.0, 2.0) : vec2(corner == 1 ? -1.7320508 : 1.7320508, -1.0);
  vec3 world = sphere.xyz + sphere.w * (from_centre.x * side + from_centre.y * cross(side, to_sun.xyz));
  gl_Position = vec4(2.0 * (shadow_from_world * vec4(world, 1.0)).xyz - 1.0, 1.0);
}
