#version 330 core
#include "common.glsl"
layout(location = 0) in vec4 sphere;  // centre, radius [m]
out vec3 from_centre;                 // x, z in radii; height of the centre, 1 = out of reach
flat out float v_radius;              // as the height

// Seen from below, as contact.vert.
void main() {
  int corner = gl_VertexID % 3;
  vec2 p = corner == 0 ? vec2(0.0, 2.0) : vec2(corner == 1 ? -1.7320508 : 1.7320508, -1.0);
  v_radius = sphere.w * contact_look.x;
  from_centre = vec3(p, (sphere.y - ground.x) * contact_look.x);
  vec2 uv = (sphere.xz + sphere.w * p - contact.xy) * contact.zw;
  gl_Position = vec4(2.0 * uv - 1.0, clamp(from_centre.z - v_radius, -0.999, 0.999), 1.0);
}
