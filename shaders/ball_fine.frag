#version 330 core
#define FINE
#include "ball.glsl"
