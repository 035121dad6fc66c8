#version 330 core
#include "srgb.glsl"
in vec3 direction;
flat in vec4 v_zenith, v_horizon, v_sun, v_to_sun;
#define sky_zenith v_zenith
#define sky_horizon v_horizon
#define sun_colour v_sun
#define to_sun v_to_sun
#include "sky.glsl"
out vec4 picture_out;
void main() { picture_out = vec4(sky_colour(normalize(direction)), 1.0); }
