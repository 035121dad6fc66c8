#version 330 core
layout(location = 0) in vec2 position;  // UI units from the top left
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 colour;  // sRGB
layout(std140) uniform Ui { vec4 size; };
out vec2 v_uv;
out vec4 v_colour;
void main() {
  v_uv = uv;
  v_colour = colour;
  gl_Position = vec4(2.0 * position.x / size.x - 1.0, 1.0 - 2.0 * position.y / size.y, 0.0, 1.0);
}
