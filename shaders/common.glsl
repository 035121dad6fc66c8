// Shared by every shader: the frame's constants, and colour.
layout(std140) uniform Frame {
  mat4 clip_from_world;
  mat4 shadow_from_world;
  vec4 eye;          // xyz [m], far distance [m]
  vec4 view_right;   // xyz: half the picture's width at distance 1
  vec4 view_up;
  vec4 view_forward;
  vec4 to_sun;       // unit
  vec4 sun_colour;   // times intensity
  vec4 zenith;       // light of the sky, times ambient
  vec4 horizon;
  vec4 below;
  vec4 sky_zenith;   // the sky as seen
  vec4 sky_horizon;
  vec4 haze;         // sRGB
  vec4 ground;       // height [m], grid spacing [m], grid on, haze rate [1/m]
  vec4 ground_colour;
  vec4 grid_colour;  // a: strength of the fine lines
  vec4 contact;      // x0, z0 [m], 1/width, 1/depth [1/m]
  vec4 contact_look; // height scale [1/m], strength
  vec4 shadow_look;  // texel in shadow coordinates, normal offset [m], on
  vec4 picture;      // width, height [px], ui scale, exposure
};

// sRGB curve without pow; error below 1/400 (fit by I. Taylor, chilliant.com).
vec3 srgb_from_linear(vec3 c) {
  vec3 a = sqrt(c), b = sqrt(a), d = sqrt(b);
  return max(0.662002687 * a + 0.684122060 * b - 0.323583601 * d - 0.0225411470 * c, 0.0);
}

// Radiance to picture. Colours are kept as painted up to three quarters of white; brighter ones
// roll off towards white (the Khronos PBR neutral curve, 2024, without its toe, which turns
// shadows blue).
vec3 picture_colour(vec3 radiance) {
  vec3 c = radiance * picture.w;
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

// The sky as seen along a unit direction, in picture colours: drawn as chosen, not exposed.
vec3 sky_colour(vec3 d) {
  float t = 1.0 - max(d.y, 0.0);
  float t2 = t * t;
  vec3 c = mix(sky_zenith.rgb, sky_horizon.rgb, t2 * t2);
  float s = max(dot(d, to_sun.xyz), 0.0);
  float s4 = s * s * s * s;
  float s16 = s4 * s4 * s4 * s4;
  c += sun_colour.rgb * (0.015 * s4 + 0.04 * s16 * s16) * clamp(3.0 * d.y, 0.0, 1.0);
  return srgb_from_linear(clamp(c, 0.0, 1.0));
}
