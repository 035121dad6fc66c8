#version 330 core
in vec4 v_colour;
in float across;
flat in float half_pixels;
out vec4 picture_out;
void main() {
  float cover = clamp(half_pixels + 0.5 - abs(across), 0.0, 1.0);
  picture_out = vec4(v_colour.rgb, v_colour.a * cover);
}
