#version 330 core
#define FINE
#define PATTERNED
#include "ball.glsl"
