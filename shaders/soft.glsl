// Constants of liquids and smoke, and distances from the depth buffer.
layout(std140) uniform Soft {
  mat4 veil_from_world;  // to 0..1 over the raster of what is left of the sun, and in depth
  vec4 veil;             // 1 / softness of its front, pixels of the picture by one of its shade, -, -
  vec4 depths;           // near, far [m], pixels of the picture at distance 1, and by texel of smoke
  vec4 absorb;           // [1/m]; thickness that a chord stands for over its length
  vec4 body;             // colour of the liquid, linear; most foam
  vec4 smoothing;        // reach [m], narrow range [m], step behind it [m], most pixels
  vec4 ball;             // radius [m]
};

// Distance along the line of sight of the picture's middle [m].
float distance_of(float depth) {
  return depths.x * depths.y / (depths.y - depth * (depths.y - depths.x));
}
float depth_of(float z) {
  return depths.y * (z - depths.x) / (z * (depths.y - depths.x));
}

// The point at this distance behind a place of the picture, -1..1.
vec3 point_at(vec2 s, float z) {
  return eye.xyz + z * (view_forward.xyz + s.x * view_right.xyz + s.y * view_up.xyz);
}

vec3 linear_from_srgb(vec3 c) {
  return c * (c * (c * 0.305306011 + 0.682171111) + 0.012522878);
}
