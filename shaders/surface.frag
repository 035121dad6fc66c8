#version 330 core
#include "surface.glsl"
