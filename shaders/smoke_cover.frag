#version 330 core
// Smoke over the picture, from a target of fewer pixels: of the four around a pixel those count
// whose solid background is as far away as its own, so that edges before and behind smoke stay sharp
// (joint bilateral upsampling, Kopf et al. 2007).
uniform sampler2D smoke;
uniform sampler2D scene_depth;
flat in vec3 v_depths;
out vec4 picture_out;

// near * far / distance of what is solid.
float closeness(ivec2 pixel) {
  float depth = texelFetch(scene_depth, pixel, 0).r;
  return v_depths.y - depth * (v_depths.y - v_depths.x);
}

// What counts of a texel with this bilinear share.
float weight(ivec2 texel, float share, float by_own) {
  ivec2 pixel = ivec2(v_depths.z * (vec2(texel) + 0.5));
  float other = closeness(min(pixel, textureSize(scene_depth, 0) - 1));
  return share / (0.02 + abs(other * by_own - 1.0)) + 1e-4;
}

void main() {
  vec2 place = gl_FragCoord.xy / v_depths.z - 0.5, low = floor(place), f = place - low, g = 1.0 - f;
  ivec2 a = max(ivec2(low), 0), d = min(ivec2(low) + 1, textureSize(smoke, 0) - 1);
  ivec2 b = ivec2(d.x, a.y), c = ivec2(a.x, d.y);
  // Premultiplied, and what is left.
  vec4 at_a = texelFetch(smoke, a, 0), at_b = texelFetch(smoke, b, 0);
  vec4 at_c = texelFetch(smoke, c, 0), at_d = texelFetch(smoke, d, 0);
  if (min(min(at_a.a, at_b.a), min(at_c.a, at_d.a)) == 1.0) discard;
  float by_own = 1.0 / closeness(ivec2(gl_FragCoord.xy));
  float w_a = weight(a, g.x * g.y, by_own), w_b = weight(b, f.x * g.y, by_own);
  float w_c = weight(c, g.x * f.y, by_own), w_d = weight(d, f.x * f.y, by_own);
  vec4 sum = (w_a * at_a + w_b * at_b + w_c * at_c + w_d * at_d) / (w_a + w_b + w_c + w_d);
  picture_out = vec4(sum.rgb, 1.0 - sum.a);
}
