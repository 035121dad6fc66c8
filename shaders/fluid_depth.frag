#version 330 core
// Where the nearest ball of a liquid is: its distance, and the depth that sorts them.
#include "common.glsl"
#include "soft.glsl"
in vec3 on_card;
flat in vec4 v_sphere;
flat in float v_foam;
out vec4 picture_out;

void main() {
  vec3 ray = normalize(on_card - eye.xyz);
  vec3 from_centre = eye.xyz - v_sphere.xyz;
  vec3 nearest = from_centre - dot(from_centre, ray) * ray;
  float miss2 = dot(nearest, nearest), r2 = v_sphere.w * v_sphere.w;
  if (miss2 > r2) discard;
  vec3 at = v_sphere.xyz + nearest - sqrt(r2 - miss2) * ray;
  float z = dot(at - eye.xyz, view_forward.xyz);
  gl_FragDepth = depth_of(z);
  picture_out = vec4(z, 0.0, 0.0, 1.0);
}
