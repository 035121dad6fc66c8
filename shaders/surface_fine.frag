#version 330 core
#define FINE
#include "surface.glsl"
