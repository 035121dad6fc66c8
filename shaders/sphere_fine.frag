#version 330 core
#define FINE
#include "sphere.glsl"
