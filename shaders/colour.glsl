// Colour: of light, of the sky, and as the picture has it.

#include "srgb.glsl"

// Radiance to picture. Colours are kept as painted up to three quarters of white; brighter ones
// roll off towards white (the Khronos PBR neutral curve, 2024, without its toe, which turns
// shadows blue).
vec3 picture_colour(vec3 radiance) {
  vec3 c = radiance * exposure;
  // Reflections of the sky lie over every surface like a thin veil; this lifts it.
  c = max(mix(vec3(dot(c, vec3(0.2126, 0.7152, 0.0722))), c, 1.14), 0.0);
  float peak = max(c.r, max(c.g, c.b));
  if (peak > 0.76) {
    float rolled = 1.0 - 0.0576 / (peak - 0.52);
    float white = 1.0 - 1.0 / (0.15 * (peak - rolled) + 1.0);
    c = mix(c * (rolled / peak), vec3(rolled), white);
  }
  return srgb_from_linear(clamp(c, 0.0, 1.0));
}

// Light of the sky on a surface whose normal has this vertical part: three tones over the sphere.
vec3 sky_light(float up) {
  return up > 0.0 ? mix(horizon.rgb, zenith.rgb, 0.5 * up)
                  : mix(horizon.rgb, below.rgb, min(-2.0 * up, 1.0));
}
