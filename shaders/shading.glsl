// Light on surfaces: sun with soft shadow, sky, contact shade, haze.
uniform sampler2DShadow shadow_map;
uniform sampler2D contact_map;

// Tent filter over 3 x 3 texels by four bilinear comparisons, at a place of the shadow map.
float sun_visibility(vec3 s) {
  if (shadows_on <= 0.0) return 1.0;
  vec2 uv = s.xy / shadow_texel;
  vec2 base = floor(uv + 0.5);
  vec2 f = uv + 0.5 - base;
  base -= 0.5;
  vec2 w0 = 3.0 - 2.0 * f, w1 = 1.0 + 2.0 * f;
  vec2 o0 = ((2.0 - f) / w0 - 1.0 + base) * shadow_texel;
  vec2 o1 = (f / w1 + 1.0 + base) * shadow_texel;
  float z = min(s.z, 1.0);
  float sum = w0.x * w0.y * texture(shadow_map, vec3(o0.x, o0.y, z));
  sum += w1.x * w0.y * texture(shadow_map, vec3(o1.x, o0.y, z));
  sum += w0.x * w1.y * texture(shadow_map, vec3(o0.x, o1.y, z));
  sum += w1.x * w1.y * texture(shadow_map, vec3(o1.x, o1.y, z));
  return sum * (1.0 / 16.0);
}

// Two comparisons across the diagonal: half the cost, nearly as soft on bodies.
float sun_visibility_cheap(vec3 s) {
  if (shadows_on <= 0.0) return 1.0;
  float d = 0.5 * shadow_texel;
  float z = min(s.z, 1.0);
  return 0.5 * (texture(shadow_map, vec3(s.x - d, s.y - d, z)) +
                texture(shadow_map, vec3(s.x + d, s.y + d, z)));
}

// Share of the sky's light that bodies on the ground leave at a place of the contact map; `low`: 1
// at the ground, 0 out of reach.
float contact_shade(vec2 place, float low, float weight) {
  float o = texture(contact_map, place).r;
  low = max(low, 0.0);
  return 1.0 - contact_strength * weight * o * low * low;
}

// The same for a body's own surface without the map: it stands in its own contact shade.
float low_shade(float low, float weight) {
  low = clamp(low, 0.0, 1.0);
  return 1.0 - 0.7 * contact_strength * weight * low * low;
}

// Distance melts a picture colour into the sky at the horizon.
vec3 with_haze(vec3 c, float distance_to_eye) {
  float h = distance_to_eye * haze_rate;
  return mix(haze.rgb, c, 1.0 / (1.0 + h * h));
}
