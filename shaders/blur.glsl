// Gaussian of 13 texels by seven bilinear taps.
uniform sampler2D source;
in vec2 uv;
out vec4 picture_out;
void main() {
  vec2 d = STEP / vec2(textureSize(source, 0));
  float s = 0.1964825 * texture(source, uv).r;
  s += 0.2969069 * (texture(source, uv + 1.4117647 * d).r + texture(source, uv - 1.4117647 * d).r);
  s += 0.0944704 * (texture(source, uv + 3.2941176 * d).r + texture(source, uv - 3.2941176 * d).r);
  s += 0.0103814 * (texture(source, uv + 5.1764706 * d).r + texture(source, uv - 5.1764706 * d).r);
  picture_out = vec4(s, 0.0, 0.0, 1.0);
}
