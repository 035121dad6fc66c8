#version 330 core
#include "veil_shade.glsl"
