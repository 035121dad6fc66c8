#version 330 core
#include "common.glsl"
layout(location = 0) in vec3 position;  // corner of the card, in its reach
layout(location = 2) in vec4 row0;      // world from mesh
layout(location = 3) in vec4 row1;
layout(location = 4) in vec4 row2;
layout(location = 5) in vec4 colour;   // linear, opacity
layout(location = 6) in vec4 look;     // roughness, metallic, emission
layout(location = 7) in vec4 pattern;  // kind, strength, size [m], shift [m]

out vec3 on_card;  // point of the plane through the centre that faces the eye
flat out vec4 v_sphere;
flat out vec4 v_colour;
flat out vec4 v_look;
flat out vec4 v_pattern;
flat out vec3 axis0, axis1, axis2;  // of the body, in the world
flat out float pixel;               // [m] at the ball's distance

// One triangle around the exact outline, as for particles (sphere.vert).
void main() {
  vec3 centre = vec3(row0.w, row1.w, row2.w);
  vec3 c0 = vec3(row0.x, row1.x, row2.x), c1 = vec3(row0.y, row1.y, row2.y),
       c2 = vec3(row0.z, row1.z, row2.z);
  float radius = length(c0);
  axis0 = c0 / radius;
  axis1 = c1 / radius;
  axis2 = c2 / radius;
  vec3 to = centre - eye.xyz;
  float d = length(to);
  float sine = min(radius / d, 0.98);
  pixel = 2.0 * length(view_up.xyz) / picture.y * d;
  float reach = 2.0 * (radius * inversesqrt(1.0 - sine * sine) + pixel);
  vec3 right = normalize(cross(to, view_up.xyz));
  vec3 up = cross(right, to / d);
  on_card = centre + reach * (position.x * right + position.y * up);
  v_sphere = vec4(centre, radius);
  v_colour = colour;
  v_look = look;
  v_pattern = pattern;
  gl_Position = clip_from_world * vec4(on_card, 1.0);
}
