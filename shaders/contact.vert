#version 330 core
#include "common.glsl"
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 row0;
layout(location = 3) in vec4 row1;
layout(location = 4) in vec4 row2;
layout(location = 6) in vec4 look;
out float nearness;

// Seen from below, so that the lowest surface wins.
void main() {
  vec3 c0 = vec3(row0.x, row1.x, row2.x), c1 = vec3(row0.y, row1.y, row2.y),
       c2 = vec3(row0.z, row1.z, row2.z);
  vec3 world = c0 * position.x + c1 * position.y + c2 * position.z + vec3(row0.w, row1.w, row2.w);
  if (look.w > 0.0) {
    vec3 n = normal * inversesqrt(vec3(dot(c0, c0), dot(c1, c1), dot(c2, c2)));
    world += look.w * (c0 * n.x + c1 * n.y + c2 * n.z);
  }
  float up = (world.y - ground.x) * contact_look.x;
  nearness = 1.0 - up;
  vec2 uv = (world.xz - contact.xy) * contact.zw;
  gl_Position = vec4(2.0 * uv - 1.0, clamp(up, -0.999, 0.999), 1.0);
}
