#version 330 core
#include "common.glsl"
out vec3 world;
// A disc around the eye, cut into wedges so that interpolation stays exact near the camera.
void main() {
  const float reach = 4000.0;
  int corner = gl_VertexID;
  vec2 p = vec2(float((corner << 1) & 2), float(corner & 2)) - 1.0;
  world = vec3(eye.x + reach * p.x, ground.x, eye.z + reach * p.y);
  gl_Position = clip_from_world * vec4(world, 1.0);
}
