// Shared by every shader: the frame's constants, and colour.
layout(std140) uniform Frame {
  mat4 clip_from_world;
  mat4 shadow_from_world;
  vec4 eye;          // xyz [m]
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
  vec4 ground;       // height [m], grid spacing [m], grid on, haze rate [1/m]
  vec4 ground_colour;
  vec4 grid_colour;
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

// Filmic curve, a fit to ACES with a softer shoulder (after Narkowicz 2015), then sRGB.
vec3 picture_colour(vec3 radiance) {
  vec3 x = radiance * picture.w;
  vec3 y = (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
  return srgb_from_linear(clamp(y, 0.0, 1.0));
}

// Light of the sky on a surface of normal n: three tones over the sphere.
vec3 sky_light(float up) {
  return up > 0.0 ? mix(horizon.rgb, zenith.rgb, up) : mix(horizon.rgb, below.rgb, min(-2.0 * up, 1.0));
}

// The sky as seen along a unit direction.
vec3 sky_colour(vec3 d) {
  float t = 1.0 - max(d.y, 0.0);
  float t2 = t * t;
  vec3 c = mix(sky_zenith.rgb, sky_horizon.rgb, t2 * t2);
  float s = max(dot(d, to_sun.xyz), 0.0);
  float s4 = s * s * s * s;
  float s16 = s4 * s4 * s4 * s4;
  return c + sun_colour.rgb * (0.02 * s4 + 0.06 * s16 * s16);
}
