#version 330 core
// How far away the ground is, and nothing else of it: the same triangles as ground.vert.
#include "frame.glsl"
layout(location = 0) in vec2 place;  // x, z [m]
void main() { gl_Position = clip_from_world * vec4(place.x, ground.x, place.y, 1.0); }
