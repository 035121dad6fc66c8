#version 330 core
#define GLASS
#include "surface.glsl"
