#version 330 core
in vec4 v_colour;
in vec2 from_centre;
flat in float radius;
out vec4 picture_out;
void main() {
  float d = length(from_centre);
  float cover = clamp(radius + 0.5 - d, 0.0, 1.0);
  float edge = clamp(radius - 0.5 - d, 0.0, 1.0);  // a dark rim keeps marks readable on any surface
  picture_out = vec4(v_colour.rgb * mix(0.45, 1.0, edge), v_colour.a * cover);
}
