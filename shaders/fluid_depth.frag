#version 330 core
// Where the nearest ellipsoid of a liquid is: its distance, and the depth that sorts them.
#include "common.glsl"
#include "soft.glsl"
in vec3 on_card;
flat in vec4 v_sphere;
flat in vec3 v_squeeze, v_shear;
flat in float v_foam;
out vec4 picture_out;

void main() {
  vec3 ray = normalize(on_card - eye.xyz);
  vec3 from_centre = eye.xyz - v_sphere.xyz;
  vec3 nearest = from_centre - dot(from_centre, ray) * ray;
  // As if it were a ball.
  mat3 to_ball = mat3(v_squeeze.x, v_shear.x, v_shear.y, v_shear.x, v_squeeze.y, v_shear.z,
                      v_shear.y, v_shear.z, v_squeeze.z);
  vec3 p = to_ball * nearest, d = to_ball * ray;
  float dd = dot(d, d), pd = dot(p, d);
  float root2 = pd * pd - dd * (dot(p, p) - v_sphere.w * v_sphere.w);
  if (root2 < 0.0) discard;
  vec3 at = v_sphere.xyz + nearest - (pd + sqrt(root2)) / dd * ray;
  float z = dot(at - eye.xyz, view_forward.xyz);
  gl_FragDepth = depth_of(z);
  picture_out = vec4(z, 0.0, 0.0, 1.0);
}
