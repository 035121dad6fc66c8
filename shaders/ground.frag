#version 330 core
#include "ground.glsl"
