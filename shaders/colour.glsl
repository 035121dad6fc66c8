// Colour: of light, of the sky, and as the picture has it.

#include "srgb.glsl"

// Radiance to picture. Colours are kept as painted up to three quarters of white; brighter ones
// roll off towards white (the Khronos PBR neutral curve, 2024, without its toe, which turns
// shadows blue).
vec3 picture_colour(vec3 radiance) {
  vec3 c = radiance * exposure;
  // Reflections of the sky lie over every surface like a thin veil; this lifts it.
  c = clamp(mix(vec3(dot(c, vec3(0.2126, 0.7152, 0.0722))), c, 1.14), 0.0, 1e6);
  // With p the brightest of the three: rolled = 1 - 0.24^2 / (p - 0.52), white = 1 - 1 / (1 + 0.15 (p -
  // rolled)), and the colour mix(c * rolled / p, rolled, white), over one common denominator. At 0.76
  // this leaves c as it is.
  float p = max(max(c.r, 0.76), max(c.g, c.b)), over = p - 0.52;
  float whitens = 0.15 * (p * over - over + 0.0576), all = over + whitens;
  float share = (over - 0.0576) / (p * over * all);
  return srgb_from_linear(share * over * c + share * whitens * p);
}

// Light of the sky on a surface whose normal has this vertical part: three tones over the sphere.
vec3 sky_light(float up) {
  return up > 0.0 ? mix(horizon.rgb, zenith.rgb, 0.5 * up)
                  : mix(horizon.rgb, below.rgb, min(-2.0 * up, 1.0));
}
