#version 330 core
#include "common.glsl"
layout(location = 0) in vec4 sphere;  // centre, radius [m]
layout(location = 1) in vec4 colour;  // linear, opacity; beyond 1: glow

out vec3 on_card;  // point of the plane through the centre that faces the eye
flat out vec4 v_sphere;
flat out vec4 v_colour;
flat out float pixel;  // [m] at the sphere's distance

// One triangle per particle around its exact outline: the cone of sight that touches the sphere
// cuts the plane through the centre at r / sqrt(1 - (r/d)^2). Half a pixel more softens the edge.
void main() {
  vec3 to = sphere.xyz - eye.xyz;
  float d = length(to);
  float sine = min(sphere.w / d, 0.98);
  pixel = 2.0 * length(view_up.xyz) / picture.y * d;
  float reach = 2.0 * (sphere.w * inversesqrt(1.0 - sine * sine) + 0.6 * pixel);
  vec3 right = normalize(cross(to, view_up.xyz));
  vec3 up = cross(right, to / d);
  int corner = gl_VertexID % 3;
  vec2 p = corner == 0 ? vec2(0.0, 1.0) : vec2(corner == 1 ? -0.8660254 : 0.8660254, -0.5);
  on_card = sphere.xyz + reach * (p.x * right + p.y * up);
  v_sphere = sphere;
  v_colour = colour;
  gl_Position = clip_from_world * vec4(on_card, 1.0);
}
