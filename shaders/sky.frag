#version 330 core
in vec3 colour;
in float above;
flat in vec3 at_horizon;
out vec4 picture_out;
void main() { picture_out = vec4(above > 0.0 ? colour : at_horizon, 1.0); }
