#version 330 core
uniform sampler2D source;
in vec2 uv;
out vec4 picture_out;
void main() {
  picture_out = vec4(texture(source, uv).rgb, 1.0);
}
