#version 330 core
#define BARE
#include "ground.glsl"
