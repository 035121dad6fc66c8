// The shade of liquids and smoke on what has been drawn: a factor of its colour, or with LAYER, for
// shade without a colour, what is left of it.
#include "light.glsl"
#include "colour.glsl"
#include "shading.glsl"
uniform sampler2D scene_depth;
uniform sampler2D sun_veil;
in vec3 ray, ray_in_veil, ray_in_shadow;
flat in vec4 eye_in_veil, eye_in_shadow;
flat in vec4 step_x, step_y, step_z;  // step_z.w: pixels of the picture that one of these stands for
out vec4 picture_out;

void main() {
  ivec2 pixel = min(ivec2(step_z.w * gl_FragCoord.xy), textureSize(scene_depth, 0) - 1);
  float depth = texelFetch(scene_depth, pixel, 0).r;
  float near = step_x.w, far = step_y.w;
  float z = near * far / (far - depth * (far - near));
  vec3 at = z * ray;  // from the eye
  vec3 across = cross(dFdx(at), dFdy(at));
  vec3 in_veil = eye_in_veil.xyz + z * ray_in_veil;
  vec2 rim = abs(in_veil.xy - 0.5);
  if (depth >= 1.0 || max(rim.x, rim.y) > 0.5) discard;
  vec4 left = texture(sun_veil, in_veil.xy);
  float behind = clamp((in_veil.z - left.a) * eye_in_veil.w, 0.0, 1.0);
  float size = length(across);
  vec3 n = size > 0.0 ? across / size : vec3(0.0, 1.0, 0.0);
  vec3 in_shadow = eye_in_shadow.xyz + z * ray_in_shadow +
                   vec3(dot(step_x.xyz, n), dot(step_y.xyz, n), dot(step_z.xyz, n));
  float sun = max(dot(n, to_sun.xyz), 0.0) * dot(sun_colour.rgb, vec3(0.333)) *
              sun_visibility_cheap(in_shadow);
  float share = sun / (sun + dot(sky_light(n.y), vec3(0.333)) + 1e-4);
  vec3 shade = srgb_from_linear(1.0 - behind * share * (1.0 - left.rgb));
#ifdef LAYER
  picture_out = vec4(0.0, 0.0, 0.0, shade.g);
#else
  picture_out = vec4(shade, 1.0);
#endif
}
