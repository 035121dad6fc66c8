// One direction of the narrow-range filter (N. Truong and C. Yuksel, "A narrow-range filter for
// screen-space fluid rendering", 2018): a Gaussian over distances that are near the middle's. What
// is farther counts as just behind it, so that edges stay; what is nearer does not count, nor does
// what stands opposite to it, so that the surface does not tilt. The range grows with what it took
// in.
#include "common.glsl"
#include "soft.glsl"
uniform sampler2D source;  // distance [m]; 0: no liquid
out vec4 picture_out;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(source, 0) - 1;
  float z = texelFetch(source, at, 0).r;
  picture_out = vec4(0.0, 0.0, 0.0, 1.0);
  if (z <= 0.0) return;
  float reach = min(smoothing.x * depths.z / z, smoothing.w);
  int steps = int(ceil(reach));
  // exp(-k i^2) from one step to the next by two products.
  float ratio = exp(-4.5 / (reach * reach)), weight = 1.0, next = ratio, ratio2 = ratio * ratio;
  float nearest = z - smoothing.y, farthest = z + smoothing.y, beyond = z + smoothing.z;
  float sum = z, weights = 1.0;
  for (int i = 1; i <= steps; ++i) {
    weight *= next;
    next *= ratio2;
    float a = texelFetch(source, min(at + i * DIRECTION, last), 0).r;
    float b = texelFetch(source, max(at - i * DIRECTION, ivec2(0)), 0).r;
    a = a > 0.0 ? a : 1e9;
    b = b > 0.0 ? b : 1e9;
    if (min(a, b) < nearest) continue;
    float both = min(max(a, b), 1e8);
    nearest = min(nearest, min(a, b) - smoothing.y);
    sum += weight * ((a > farthest ? beyond : a) + (b > farthest ? beyond : b));
    if (both <= farthest) farthest = max(farthest, both + smoothing.y);
    weights += 2.0 * weight;
  }
  picture_out.r = sum / weights;
}
