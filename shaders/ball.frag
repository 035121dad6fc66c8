#version 330 core
#include "ball.glsl"
