#version 330 core
// A soft puff that faces the eye: its picture says how dense it is and which way it bulges.
uniform sampler2D puffs;  // bulge -1..1 in 0..1, density
uniform sampler2D scene_depth;
in vec2 on_puff;
in vec2 on_card;
flat in vec3 lit, shaded;
flat in vec3 sun_in_puff;
flat in float scale;  // pixels of the picture that one of these stands for
flat in vec4 v_look;  // opacity, radius [m], near, far [m]
in float z;
out vec4 picture_out;

void main() {
  float inside = 1.0 - dot(on_card, on_card);
  if (inside <= 0.0) discard;
  float opacity = v_look.x, radius = v_look.y, near = v_look.z, far = v_look.w;
  // It has a thickness: less of it is seen the less of that is in front of what is solid.
  ivec2 pixel = min(ivec2(scale * gl_FragCoord.xy), textureSize(scene_depth, 0) - 1);
  float depth = texelFetch(scene_depth, pixel, 0).r;
  float wall = near * far / (far - depth * (far - near));  // [m]
  float thick = radius * sqrt(inside) + 1e-5;
  float seen = clamp((wall - z + thick) / (2.0 * thick), 0.0, 1.0);
  // Nor does it slap into the eye.
  float near_fade = clamp((z - near) / radius, 0.0, 1.0);
  vec4 puff = texture(puffs, on_puff);
  float alpha = opacity * puff.a * seen * near_fade;
  if (alpha < 0.002) discard;
  float side = dot(puff.xyz * 2.0 - 1.0, sun_in_puff);
  vec3 c = mix(shaded, lit, clamp(0.55 + 0.55 * side, 0.0, 1.0));
  picture_out = vec4(c * alpha, alpha);
}
