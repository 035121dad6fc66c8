#version 330 core
uniform sampler2D image;
in vec2 v_uv;
in vec4 v_colour;
out vec4 picture_out;
void main() { picture_out = vec4(texture(image, v_uv).rgb, 1.0); }
