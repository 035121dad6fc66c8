// sRGB curve without pow; error below 1/400 (fit by I. Taylor, chilliant.com).
vec3 srgb_from_linear(vec3 c) {
  vec3 a = sqrt(c), b = sqrt(a), d = sqrt(b);
  return max(0.662002687 * a + 0.684122060 * b - 0.323583601 * d - 0.0225411470 * c, 0.0);
}
