// sRGB curve without pow: its linear part below 0.0031308, and above it a quartic in the square root,
// the best in the sense of Chebyshev. Its error is below a fifth of a step of 8 bits.
vec3 srgb_from_linear(vec3 c) {
  vec3 s = sqrt(c);
  vec3 curve = (((-0.3097626 * s + 0.8432225) * s - 0.945189) * s + 1.447994) * s - 0.03701269;
  return mix(curve, 12.92 * c, lessThan(c, vec3(0.0031308)));
}
