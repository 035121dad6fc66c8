#version 330 core
in vec3 from_centre;
flat in float v_radius;
out vec4 picture_out;
void main() {
  float r2 = dot(from_centre.xy, from_centre.xy);
  if (r2 > 1.0) discard;
  float t = clamp(1.0 - from_centre.z + v_radius * sqrt(1.0 - r2), 0.0, 1.0);
  picture_out = vec4(t * t, 0.0, 0.0, 1.0);
}
