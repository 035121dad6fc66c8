#version 330 core
#define PATTERNED
#include "ball.glsl"
