#version 330 core
#include "sphere.glsl"
