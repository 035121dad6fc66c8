#version 330 core
#define STEP vec2(0.0, 1.0)
#include "blur.glsl"
