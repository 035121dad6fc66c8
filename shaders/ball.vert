#version 330 core
#define LIGHT_OUT
#include "common.glsl"
#include "light.glsl"
layout(location = 0) in vec3 position;  // corner of the card, in its reach
layout(location = 2) in vec4 row0;      // world from mesh
layout(location = 3) in vec4 row1;
layout(location = 4) in vec4 row2;
layout(location = 5) in vec4 colour;   // linear, opacity
layout(location = 6) in vec4 look;     // roughness, metallic, emission
layout(location = 7) in vec4 pattern;  // kind, strength, size [m], shift [m]

out vec3 ray;  // from the eye to the plane through the centre that faces it

// Sixteen vectors with the light, as many as every device has.
flat out vec4 v_sphere;      // eye, seen from the centre; radius
flat out vec4 v_colour;      // linear; where the centre is in the contact map, across
flat out vec4 v_look;        // a: size of a pixel at the ball's distance [m]
flat out vec4 v_pattern;
flat out vec4 axis0, axis1;  // of the body, in the world; depth is axis0.w + axis1.w / distance
flat out vec4 v_ahead;       // line of sight of the picture's middle; lowness of the centre
flat out vec4 v_shadow;      // where the centre is in the shadow map; depth there by [m] to the sun
flat out vec4 v_across;      // the shadow map's u by [m]; the contact map's v

// One triangle around the exact outline, as for particles (sphere.vert).
void main() {
  vec3 centre = vec3(row0.w, row1.w, row2.w);
  vec3 c0 = vec3(row0.x, row1.x, row2.x), c1 = vec3(row0.y, row1.y, row2.y);
  float radius = length(c0);
  vec3 to = centre - eye.xyz;
  float d = length(to);
  float sine = min(radius / d, 0.98);
  float pixel = 2.0 * length(view_up.xyz) / picture.y * d;
  float reach = 2.0 * (radius * inversesqrt(1.0 - sine * sine) + 0.6 * pixel);
  vec3 right = normalize(cross(to, view_up.xyz));
  vec3 up = cross(right, to / d);
  vec3 on_card = centre + reach * (position.x * right + position.y * up);
  ray = on_card - eye.xyz;
  vec2 on_ground = in_contact_map(centre);
  v_sphere = vec4(-to, radius);
  v_colour = vec4(colour.rgb, on_ground.x);
  v_look = vec4(look.xyz, pixel);
  v_pattern = pattern;
  vec2 at_eye = (clip_from_world * vec4(eye.xyz, 1.0)).zw;
  vec2 ahead = (clip_from_world * vec4(eye.xyz + view_forward.xyz, 1.0)).zw - at_eye;
  axis0 = vec4(c0 / radius, 0.5 * ahead.x / ahead.y + 0.5);
  axis1 = vec4(c1 / radius, 0.5 * at_eye.x / ahead.y);
  v_ahead = vec4(view_forward.xyz, lowness(centre.y));
  // The sphere is looked up a little outside of itself, along its normals.
  float outside = 1.0 + shadow_look.y / radius;
  mat3 turn = transpose(mat3(shadow_from_world));
  v_shadow = vec4(in_shadow_map(centre, vec3(0.0)), outside * dot(turn[2], to_sun.xyz));
  v_across = vec4(outside * turn[0], on_ground.y);
  hand_light();
  gl_Position = clip_from_world * vec4(on_card, 1.0);
}
