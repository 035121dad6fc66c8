#version 330 core
#define DIRECTION ivec2(0, 1)
#include "narrow_range.glsl"
