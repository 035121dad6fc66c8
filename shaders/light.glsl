// What lights a surface, handed from the vertex shader (LIGHT_OUT) to the fragment shader. A
// processor that draws (llvmpipe) spends some thirty instructions on every number of a uniform block
// that a fragment shader reads, and one on a flat input: so these take the names of the constants.
#ifdef LIGHT_OUT
out
#else
in
#endif
Light {
  flat vec4 to_sun;      // unit; exposure
  flat vec4 sun_colour;  // times intensity; share of haze at a distance [1/m]
  flat vec4 zenith;      // light of the sky, times ambient; 1/height of contact shade [1/m]
  flat vec4 horizon;     // strength of contact shade
  flat vec4 below;       // texel in shadow coordinates; 0: there are no shadows
  flat vec4 haze;        // sRGB; the contact map by [m]
}
#ifdef LIGHT_OUT
light;

void hand_light() {
  light.to_sun = vec4(to_sun.xyz, exposure);
  light.sun_colour = vec4(sun_colour.rgb, haze_rate);
  light.zenith = vec4(zenith.rgb, low_slope);
  light.horizon = vec4(horizon.rgb, contact_strength);
  light.below = vec4(below.rgb, shadows_on > 0.5 ? shadow_texel : 0.0);
  light.haze = vec4(haze.rgb, contact.z);
}
#else
;
#define exposure to_sun.w
#define haze_rate sun_colour.w
#define low_slope zenith.w
#define contact_strength horizon.w
#define shadow_texel below.w
#define shadows_on below.w
#define contact_scale haze.w
#endif
