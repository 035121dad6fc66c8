#version 330 core
#include "common.glsl"
out vec3 world;
// A square around the eye, out to where haze has swallowed it.
void main() {
  float reach = 1.1 * eye.w;
  int corner = gl_VertexID;
  vec2 p = vec2(float((corner << 1) & 2), float(corner & 2)) - 1.0;
  world = vec3(eye.x + reach * p.x, ground.x, eye.z + reach * p.y);
  gl_Position = clip_from_world * vec4(world, 1.0);
}
