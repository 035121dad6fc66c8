#version 330 core
#define PATTERNED
#include "surface.glsl"
