#version 330 core
#include "common.glsl"
layout(location = 0) in vec2 place;  // x, z [m]
out vec3 world;
void main() {
  world = vec3(place.x, ground.x, place.y);
  gl_Position = clip_from_world * vec4(world, 1.0);
}
