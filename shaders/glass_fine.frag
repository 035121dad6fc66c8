#version 330 core
#define FINE
#define GLASS
#include "surface.glsl"
