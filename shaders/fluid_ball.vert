#version 330 core
#include "common.glsl"
layout(location = 0) in vec4 sphere;  // centre, longest half axis [m]
layout(location = 1) in vec3 squeeze;  // what makes a ball of the ellipsoid: xx, yy, zz
layout(location = 2) in vec3 shear;    // xy, xz, yz
layout(location = 3) in float foam;

out vec3 on_card;  // point of the plane through the centre that faces the eye
flat out vec4 v_sphere;
flat out vec3 v_squeeze, v_shear;
flat out float v_foam;

// One triangle around the outline of the ball that holds it, as for particles (sphere.vert).
void main() {
  vec3 to = sphere.xyz - eye.xyz;
  float d = length(to);
  float sine = min(sphere.w / d, 0.98);
  float reach = 2.0 * sphere.w * inversesqrt(1.0 - sine * sine);
  vec3 right = normalize(cross(to, view_up.xyz));
  vec3 up = cross(right, to / d);
  int corner = gl_VertexID % 3;
  vec2 p = corner == 0 ? vec2(0.0, 1.0) : vec2(corner == 1 ? -0.8660254 : 0.8660254, -0.5);
  on_card = sphere.xyz + reach * (p.x * right + p.y * up);
  v_sphere = sphere;
  v_squeeze = squeeze;
  v_shear = shear;
  v_foam = foam;
  gl_Position = clip_from_world * vec4(on_card, 1.0);
}
