#version 330 core
#define FINE
#define GLASS
#define PATTERNED
#include "surface.glsl"
