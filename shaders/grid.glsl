// The grid on the ground.

// Share of a pixel of width w that lines at whole numbers, `half_width` wide, cover: the exact
// box-filtered integral, so that far lines fade to their mean instead of flickering.
vec2 line_cover(vec2 p, vec2 w, float half_width) {
  vec2 a = p + 0.5 * w, b = p - 0.5 * w;
  vec2 fa = floor(a) + min(fract(a) / (2.0 * half_width), 1.0);
  vec2 fb = floor(b) + min(fract(b) / (2.0 * half_width), 1.0);
  return 2.0 * half_width * (fa - fb) / w;
}
// Lines are `half_width` cells wide, but never wider than three pixels.
float grid_cover(vec2 p, float half_width) {
  vec2 w = max(fwidth(p), 1e-5);
  float wide = min(half_width, 1.5 * max(w.x, w.y));
  vec2 c = clamp(line_cover(p + wide, w, wide), 0.0, 1.0);
  // Beyond half a cell a pixel the lines are one flat tone; let them go.
  c *= clamp(1.5 - 3.0 * w, 0.0, 1.0);
  return max(c.x, c.y);
}
// Both grids at a place in cells; `fine`: strength of the finer lines.
float lines_cover(vec2 p, float fine) {
  return max(0.7 * fine * grid_cover(p, 0.009), (0.7 + 0.3 * fine) * grid_cover(0.1 * p, 0.0018));
}
