#version 330 core
#define STEP vec2(1.0, 0.0)
#include "blur.glsl"
