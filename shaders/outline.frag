#version 330 core
#include "srgb.glsl"
flat in vec4 v_colour;
out vec4 picture_out;
void main() { picture_out = vec4(srgb_from_linear(v_colour.rgb), v_colour.a); }
