// The sky as seen along a unit direction, in picture colours: drawn as chosen, not exposed.
// Below the horizon this one goes on as smoothly as above it.
vec3 sky_colour_beyond(vec3 d) {
  float t = 1.0 - d.y;
  float t2 = t * t;
  vec3 c = mix(sky_zenith.rgb, sky_horizon.rgb, t2 * t2);
  float s = max(dot(d, to_sun.xyz), 0.0);
  float s4 = s * s * s * s;
  float s16 = s4 * s4 * s4 * s4;
  c += sun_colour.rgb * (0.015 * s4 + 0.04 * s16 * s16) * clamp(3.0 * d.y, 0.0, 1.0);
  return srgb_from_linear(clamp(c, 0.0, 1.0));
}

// And this one is as at the horizon.
vec3 sky_colour(vec3 d) { return sky_colour_beyond(vec3(d.x, max(d.y, 0.0), d.z)); }
