// Two tones in body coordinates, so that turning can be seen.
// Sign of x with an edge one pixel wide.
float soft_sign(float x) {
  return clamp(x / max(fwidth(x), 1e-6), -1.0, 1.0);
}
float wave(float x) {  // +-1, period 2, soft edges
  return soft_sign(abs(fract(0.5 * x) * 2.0 - 1.0) - 0.5);
}
float pattern_tone(vec3 body, vec4 v_pattern) {
  float second = 0.0;
  if (v_pattern.x < 1.5) second = soft_sign(body.x) * soft_sign(body.y) * soft_sign(body.z);
  else if (v_pattern.x < 2.5) second = wave((body.x - v_pattern.w) / v_pattern.z);
  else {
    vec3 p = body / v_pattern.z + 0.013;
    second = wave(p.x) * wave(p.y) * wave(p.z);
  }
  return 1.0 - v_pattern.y * (0.5 - 0.5 * second);
}
