#version 330 core
#define FINE
#define PATTERNED
#include "surface.glsl"
