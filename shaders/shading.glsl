// Light on surfaces: sun with soft shadow, sky, contact shade, haze.
uniform sampler2DShadow shadow_map;
uniform sampler2D contact_map;

// Tent filter over 3 x 3 texels by four bilinear comparisons.
float sun_visibility(vec3 world, vec3 n) {
  if (shadow_look.z < 0.5) return 1.0;
  vec4 s = shadow_from_world * vec4(world + n * shadow_look.y, 1.0);
  vec2 texel = shadow_look.xx;
  vec2 uv = s.xy / texel;
  vec2 base = floor(uv + 0.5);
  vec2 f = uv + 0.5 - base;
  base -= 0.5;
  vec2 w0 = 3.0 - 2.0 * f, w1 = 1.0 + 2.0 * f;
  vec2 o0 = ((2.0 - f) / w0 - 1.0 + base) * texel;
  vec2 o1 = (f / w1 + 1.0 + base) * texel;
  float z = min(s.z, 1.0);
  float sum = w0.x * w0.y * texture(shadow_map, vec3(o0.x, o0.y, z));
  sum += w1.x * w0.y * texture(shadow_map, vec3(o1.x, o0.y, z));
  sum += w0.x * w1.y * texture(shadow_map, vec3(o0.x, o1.y, z));
  sum += w1.x * w1.y * texture(shadow_map, vec3(o1.x, o1.y, z));
  return sum * (1.0 / 16.0);
}

// Two comparisons across the diagonal: half the cost, nearly as soft on bodies.
float sun_visibility_cheap(vec3 world, vec3 n) {
  if (shadow_look.z < 0.5) return 1.0;
  vec3 s = (shadow_from_world * vec4(world + n * shadow_look.y, 1.0)).xyz;
  float d = 0.5 * shadow_look.x;
  float z = min(s.z, 1.0);
  return 0.5 * (texture(shadow_map, vec3(s.x - d, s.y - d, z)) +
                texture(shadow_map, vec3(s.x + d, s.y + d, z)));
}

// Share of the sky's light that bodies on the ground leave at a point.
float contact_shade(vec3 world, float weight) {
  float o = texture(contact_map, (world.xz - contact.xy) * contact.zw).r;
  float low = max(1.0 - (world.y - ground.x) * contact_look.x, 0.0);
  return 1.0 - contact_look.y * weight * o * low * low;
}

// The same for a body's own surface without the map: it stands in its own contact shade.
float low_shade(float height, float weight) {
  float low = clamp(1.0 - (height - ground.x) * contact_look.x, 0.0, 1.0);
  return 1.0 - 0.7 * contact_look.y * weight * low * low;
}

// Distance melts a picture colour into the sky at the horizon.
vec3 with_haze(vec3 c, float distance_to_eye) {
  float h = distance_to_eye * ground.w;
  return mix(haze.rgb, c, 1.0 / (1.0 + h * h));
}
