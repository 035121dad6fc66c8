// The grid on the ground.

// Share of a pixel of width w that lines at whole numbers cover, so that far lines fade to their mean
// instead of flickering: the exact box-filtered integral of the nearest one, a trapezoid. No other is in
// a pixel less than half a cell wide. Lines are `half_width` cells wide, but no wider than three pixels.
float grid_cover(vec2 p, vec2 w, vec2 by_w, float half_width) {
  float wide = min(half_width, 1.5 * max(w.x, w.y));
  vec2 off = abs(p - floor(p + 0.5));
  vec2 c = clamp((wide - off) * by_w + 0.5, vec2(0.0), min(2.0 * wide * by_w, 1.0));
  // Beyond half a cell a pixel the lines are one flat tone; let them go.
  c *= clamp(1.5 - 3.0 * w, 0.0, 1.0);
  return max(c.x, c.y);
}
// Both grids at a place in cells; `fine`: strength of the finer lines.
float lines_cover(vec2 p, float fine) {
  vec2 w = max(fwidth(p), 1e-5), by_w = 1.0 / w;
  return max(0.7 * fine * grid_cover(p, w, by_w, 0.009),
             (0.7 + 0.3 * fine) * grid_cover(0.1 * p, 0.1 * w, 10.0 * by_w, 0.0018));
}
