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

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy), last = textureSize(scene_depth, 0) - 1;
  vec2 place = gl_FragCoord.xy / v_depths.z;
  if (texture(smoke, place / vec2(textureSize(smoke, 0))).a == 0.0) discard;
  place -= 0.5;
  float own = closeness(here);
  vec2 low = floor(place), f = place - low;
  vec4 sum = vec4(0.0);
  float weights = 1e-6;
  for (int k = 0; k < 4; ++k) {
    vec2 step = vec2(float(k & 1), float(k >> 1));
    ivec2 texel = clamp(ivec2(low + step), ivec2(0), textureSize(smoke, 0) - 1);
    float other = closeness(min(ivec2(v_depths.z * (vec2(texel) + 0.5)), last));
    vec2 share = mix(1.0 - f, f, step);
    float weight = share.x * share.y / (0.02 + abs(other / own - 1.0)) + 1e-4;
    sum += weight * texelFetch(smoke, texel, 0);
    weights += weight;
  }
  picture_out = sum / weights;
}
