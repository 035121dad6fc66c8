#version 330 core
#include "frame.glsl"
#include "soft.glsl"
flat out vec3 v_depths;  // near, far [m]; pixels of the picture by texel of smoke
void main() {
  v_depths = depths.xyw;
  gl_Position = vec4(vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2)) * 2.0 - 1.0, 1.0, 1.0);
}
