#version 330 core
#define LAYER
#include "veil_shade.glsl"
