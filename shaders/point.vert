#version 330 core
#include "common.glsl"
layout(location = 0) in vec3 x;
layout(location = 1) in vec4 colour;
layout(location = 2) in float size;  // [px]
out vec4 v_colour;
out vec2 from_centre;  // [px]
flat out float radius;

void main() {
  vec4 c = clip_from_world * vec4(x, 1.0);
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  radius = 0.5 * size * picture.z;
  from_centre = corner * (radius + 1.0);
  gl_Position = vec4(c.xy + from_centre * 2.0 / picture.xy * c.w, c.z - 3e-4 * c.w, c.w);
  v_colour = vec4(srgb_from_linear(colour.rgb), colour.a);
}
