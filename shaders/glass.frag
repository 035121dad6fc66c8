#version 330 core
#define GLASS
#define PATTERNED
#include "surface.glsl"
