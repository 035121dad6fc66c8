#version 330 core
in float nearness;
out vec4 picture_out;
void main() {
  float t = clamp(nearness, 0.0, 1.0);
  picture_out = vec4(t * t, 0.0, 0.0, 1.0);
}
