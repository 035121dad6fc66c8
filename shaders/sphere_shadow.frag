#version 330 core
in vec2 from_centre;
void main() {
  if (dot(from_centre, from_centre) > 1.0) discard;
}
