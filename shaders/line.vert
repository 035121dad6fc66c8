#version 330 core
#include "common.glsl"
layout(location = 0) in vec3 a;
layout(location = 1) in vec3 b;
layout(location = 2) in vec4 colour;  // linear
layout(location = 3) in float width;  // [px]
out vec4 v_colour;
out float across;     // -1..1 over the drawn width
flat out float half_pixels;

void main() {
  vec4 ca = clip_from_world * vec4(a, 1.0), cb = clip_from_world * vec4(b, 1.0);
  const float least = 1e-3;  // cut at the eye's plane, where the projection turns over
  if (ca.w < least && cb.w > least) ca = mix(ca, cb, (least - ca.w) / (cb.w - ca.w));
  if (cb.w < least && ca.w > least) cb = mix(cb, ca, (least - cb.w) / (ca.w - cb.w));
  vec2 pa = ca.xy / ca.w * picture.xy, pb = cb.xy / cb.w * picture.xy;
  vec2 along = pb - pa;
  float l = length(along);
  along = l > 1e-6 ? along / l : vec2(1.0, 0.0);
  float side = float(gl_VertexID & 1) * 2.0 - 1.0;
  half_pixels = 0.5 * max(width * picture.z, 1.0);
  float reach = half_pixels + 0.5;
  vec4 c = gl_VertexID < 2 ? ca : cb;
  vec2 offset = (vec2(-along.y, along.x) * side + along * (gl_VertexID < 2 ? -0.3 : 0.3)) * 2.0 * reach;
  gl_Position = vec4(c.xy + offset / picture.xy * c.w, c.z - 2e-4 * c.w, c.w);
  if (ca.w < least && cb.w < least) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  across = side * reach;
  v_colour = vec4(srgb_from_linear(colour.rgb), colour.a);
}
