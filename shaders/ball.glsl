// A ball: the sphere that the ray through this pixel meets, painted and lit as any body.
#include "light.glsl"
#include "colour.glsl"
#include "lighting.glsl"
#include "pattern.glsl"
in vec3 ray;
flat in vec4 v_sphere;
flat in vec4 v_colour;
flat in vec4 v_look;
flat in vec4 v_pattern;
flat in vec4 axis0, axis1;
flat in vec4 v_ahead;
flat in vec4 v_shadow;
flat in vec4 v_across;
out vec4 picture_out;

void main() {
  vec3 from_centre = v_sphere.xyz, along = normalize(ray);
  vec3 nearest = from_centre - dot(from_centre, along) * along;  // no cancellation
  float miss2 = dot(nearest, nearest);
  float cover = clamp((v_sphere.w - sqrt(miss2)) / v_look.w + 0.5, 0.0, 1.0);
  float depth = sqrt(max(v_sphere.w * v_sphere.w - miss2, 0.0));
  vec3 at = nearest - depth * along;  // from the centre
  vec3 base = v_colour.rgb;
#ifdef PATTERNED
  // Before anything is discarded: its edges are as wide as the neighbours' differences say.
  if (v_pattern.x > 0.5)
    base *= pattern_tone(vec3(dot(axis0.xyz, at), dot(axis1.xyz, at),
                              dot(cross(axis0.xyz, axis1.xyz), at)), v_pattern);
#endif
  if (cover < 0.1) discard;
  vec3 to_eye = from_centre - at;
  gl_FragDepth = axis0.w - axis1.w / dot(v_ahead.xyz, to_eye);
  // The shadow map's axes are at right angles, its v as wide as its u.
  vec3 in_shadow = v_shadow.xyz + vec3(dot(v_across.xyz, at), dot(cross(to_sun.xyz, v_across.xyz), at),
                                       v_shadow.w * dot(to_sun.xyz, at));
  vec3 on_ground = vec3(v_colour.w + at.x * contact_scale, v_across.w + at.z * contact_scale,
                        v_ahead.w - at.y * low_slope);
  picture_out = vec4(
      lit_picture_colour(Place(to_eye, in_shadow, on_ground), normalize(at), base, v_look.xyz), cover);
}
