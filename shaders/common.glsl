// Shared by shaders that read the frame's constants.
#include "frame.glsl"
#include "colour.glsl"
#include "sky.glsl"
#include "places.glsl"
