#version 330 core
// The surface of a liquid: mirrored sky, what is seen through it, light from within, foam.
#include "common.glsl"
#include "shading.glsl"
#include "soft.glsl"
uniform sampler2D front;      // smooth distance of the surface; 0: no liquid
uniform sampler2D thickness;  // of the liquid, of foam, and as if nothing were in it, half size
uniform sampler2D scene;
uniform sampler2D scene_depth;
in vec2 uv;
out vec4 picture_out;

const float index = 1.33;  // of refraction, water

vec3 surface_at(ivec2 at, float z) {
  return point_at((vec2(at) + 0.5) / picture.xy * 2.0 - 1.0, z);
}

// Along one direction the difference to that neighbour that is less far: edges do not bend it.
vec3 slope(vec3 p, ivec2 at, ivec2 step, float z) {
  float after = texelFetch(front, at + step, 0).r, before = texelFetch(front, at - step, 0).r;
  bool forward = before <= 0.0 || (after > 0.0 && abs(after - z) < abs(z - before));
  if (forward && after <= 0.0) return point_at((vec2(at + step) + 0.5) / picture.xy * 2.0 - 1.0, z) - p;
  return forward ? surface_at(at + step, after) - p : p - surface_at(at - step, before);
}

// Where on the picture a ray through the liquid ends, and how long it is: after `most`, or at the first
// of some places along it that lie just behind what is solid there. What stands before the liquid hides
// nothing of it, and a place deep behind a body is one that the ray came to from the side.
const int looks = 14, halvings = 4;
vec3 end_of_ray(vec3 p, vec3 along, float most, float z) {
  vec4 start = clip_from_world * vec4(p, 1.0), way = clip_from_world * vec4(along, 0.0) * most;
  float t = 0.0, step = 1.0 / float(looks), end = 1.0, deepest = 1.5 * step * abs(way.w);
  for (int i = 0; i < looks + halvings && t < 1.0; ++i) {
    vec4 c = start + (t + step) * way;
    float solid = distance_of(texture(scene_depth, c.xy / c.w * 0.5 + 0.5).r);
    float over = c.w - solid;  // w is the distance
    bool behind = over > 0.0 && over < deepest && solid > z;
    if (behind) end = t + step;
    if (!behind) t += step;
    if (behind || step * float(looks) < 1.0) step *= 0.5;
  }
  vec4 c = start + end * way;
  return vec3(clamp(c.xy / c.w * 0.5 + 0.5, 0.0, 1.0), end * most);
}

// As seen along a direction, in linear light of the picture; what is below is the ground's.
vec3 mirrored(vec3 d) {
  vec3 sky = linear_from_srgb(sky_colour(vec3(d.x, max(d.y, 0.0), d.z)));
  return mix(sky, below.rgb * picture.w, clamp(-4.0 * d.y, 0.0, 1.0));
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float z = texelFetch(front, at, 0).r;
  if (z <= 0.0) discard;
  float wall = distance_of(texelFetch(scene_depth, at, 0).r);
  if (z >= wall) discard;
  vec3 p = surface_at(at, z);
  vec3 n = normalize(cross(slope(p, at, ivec2(1, 0), z), slope(p, at, ivec2(0, 1), z)));
  vec3 to_eye = eye.xyz - p;
  float distance_to_eye = length(to_eye);
  vec3 v = to_eye / distance_to_eye;
  if (dot(n, v) < 0.0) n = -n;
  float ndv = max(dot(n, v), 0.0);
  vec3 some = texture(thickness, uv).rgb;
  float thick = max(some.r, 0.0);

  // What is behind, where the bent ray comes to.
  vec3 end = end_of_ray(p, refract(-v, n, 1.0 / index), some.b, z);
  vec2 there = end.xy;
  if (distance_of(texture(scene_depth, there).r) < z) there = uv;
  vec3 straight = linear_from_srgb(texelFetch(scene, at, 0).rgb);
  vec3 background = linear_from_srgb(texture(scene, there).rgb);
  vec3 through = exp(-absorb.rgb * end.z);
  float sun = sun_visibility_cheap(in_shadow_map(p, n));
  vec3 glow = body.rgb * (sky_light(0.6) + 0.35 * sun * sun_colour.rgb) * (0.55 * picture.w);
  vec3 inside = mix(glow, background, through);

  // Schlick's Fresnel; the sun by GGX, as on bodies (lighting.glsl).
  float e = 1.0 - ndv, e2 = e * e;
  float fresnel = 0.02 + 0.98 * e2 * e2 * e;
  vec3 l = to_sun.xyz, h = normalize(l + v);
  float ndl = max(dot(n, l), 0.0), ndh = max(dot(n, h), 0.0);
  const float a2 = 0.004;
  float q = ndh * ndh * (a2 - 1.0) + 1.0;
  float spark = 0.02 * a2 / (q * q + 1e-6) * 0.25 / (ndl * ndv + 0.1) * ndl * sun;
  vec3 light = mix(inside, mirrored(reflect(-v, n)), fresnel) +
               min(spark, 4.0) * sun_colour.rgb * picture.w;

  // Broken liquid is white and lit like any matter.
  vec3 white = vec3(0.86) * (ndl * sun * sun_colour.rgb + sky_light(n.y)) * picture.w;
  float foam = body.a * smoothstep(0.15, 0.9, some.g / (ball.x * 0.8 + 1e-6));
  light = mix(light, white, foam);

  // Thin edges let through what is behind them.
  float cover = clamp(thick / (0.2 * ball.x), 0.0, 1.0);
  light = mix(straight, light, max(cover, foam));
  gl_FragDepth = depth_of(z);
  picture_out = vec4(with_haze(srgb_from_linear(clamp(light, 0.0, 1.0)), distance_to_eye), 1.0);
}
