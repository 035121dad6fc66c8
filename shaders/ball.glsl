// A ball: the sphere that the ray through this pixel meets, painted and lit as any body.
#include "lighting.glsl"
#include "pattern.glsl"
in vec3 on_card;
flat in vec4 v_sphere;
flat in vec4 v_colour;
flat in vec4 v_look;
flat in vec4 v_pattern;
flat in vec3 axis0, axis1, axis2;
flat in float pixel;
out vec4 picture_out;

void main() {
  vec3 ray = normalize(on_card - eye.xyz);
  vec3 from_centre = eye.xyz - v_sphere.xyz;
  float along = dot(from_centre, ray);
  vec3 nearest = from_centre - along * ray;  // of the ray to the centre; no cancellation
  float miss2 = dot(nearest, nearest);
  float cover = clamp((v_sphere.w - sqrt(miss2)) / pixel + 0.5, 0.0, 1.0);
  float depth = sqrt(max(v_sphere.w * v_sphere.w - miss2, 0.0));
  vec3 at = nearest - depth * ray;
  vec3 base = v_colour.rgb;
  // Before anything is discarded: its edges are as wide as the neighbours' differences say.
  if (v_pattern.x > 0.5)
    base *= pattern_tone(vec3(dot(axis0, at), dot(axis1, at), dot(axis2, at)), v_pattern);
  if (cover < 0.1) discard;
  vec3 world = v_sphere.xyz + at;
  vec4 clip = clip_from_world * vec4(world, 1.0);
  gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
  picture_out = vec4(lit_picture_colour(world, normalize(at), base, v_look.xyz), cover);
}
