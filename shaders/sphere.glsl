// A particle: the sphere that the ray through this pixel meets, lit as any body. An opacity beyond 1
// says how much light it gives off besides.
#include "common.glsl"
#include "lighting.glsl"
in vec3 on_card;
flat in vec4 v_sphere;
flat in vec4 v_colour;
flat in float pixel;
out vec4 picture_out;

void main() {
  vec3 ray = normalize(on_card - eye.xyz);
  vec3 from_centre = eye.xyz - v_sphere.xyz;
  float along = dot(from_centre, ray);
  vec3 nearest = from_centre - along * ray;  // of the ray to the centre; no cancellation
  float miss2 = dot(nearest, nearest);
  float cover = clamp((v_sphere.w - sqrt(miss2)) / pixel + 0.5, 0.0, 1.0);
  if (cover < 0.1) discard;
  float depth = sqrt(max(v_sphere.w * v_sphere.w - miss2, 0.0));
  vec3 n = normalize(nearest - depth * ray);
  vec3 world = v_sphere.xyz + nearest - depth * ray;
  vec4 clip = clip_from_world * vec4(world, 1.0);
  gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
  Place place = Place(eye.xyz - world, in_shadow_map(world, n),
                      vec3(in_contact_map(world), lowness(world.y)));
  picture_out =
      vec4(lit_picture_colour(place, n, v_colour.rgb, vec3(0.5, 0.0, max(v_colour.a - 1.0, 0.0))),
           min(v_colour.a, 1.0) * cover);
}
