#version 330 core
#define DIRECTION ivec2(1, 0)
#include "narrow_range.glsl"
