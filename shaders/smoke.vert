#version 330 core
#include "common.glsl"
#include "shading.glsl"
#include "soft.glsl"
layout(location = 0) in vec4 place;   // centre, radius [m]
layout(location = 1) in vec4 colour;  // linear, opacity
layout(location = 2) in vec4 look;    // share of the sun that smoke has left, glow, cosine, sine
layout(location = 3) in vec2 corner;  // of the puff's picture in the atlas

out vec2 on_puff;  // in the atlas
out vec2 on_card;  // -1..1
flat out vec3 lit, shaded;  // picture colours towards the sun and away from it
flat out vec3 sun_in_puff;  // direction in the axes of the puff's picture
flat out float scale;
flat out vec4 v_look;  // opacity, radius [m], near, far [m]
out float z;

void main() {
  vec3 to = place.xyz - eye.xyz;
  float d = length(to);
  vec3 ahead = to / d;
  vec3 right = normalize(cross(ahead, view_up.xyz)), up = cross(right, ahead);
  vec3 r = look.z * right + look.w * up, u = look.z * up - look.w * right;
  vec2 p = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 world = place.xyz + place.w * (p.x * r + p.y * u);
  on_card = p;
  on_puff = corner + (0.25 + 0.242 * p);
  sun_in_puff = vec3(dot(r, to_sun.xyz), dot(u, to_sun.xyz), -dot(ahead, to_sun.xyz));
  float sun = look.x * sun_visibility_cheap(in_shadow_map(place.xyz, vec3(0.0)));
  vec3 sky = mix(below.rgb, zenith.rgb, 0.6) * 0.5 + 0.5 * horizon.rgb;
  vec3 own = colour.rgb * look.y;
  lit = with_haze(picture_colour(colour.rgb * (sky + sun * sun_colour.rgb) + own), d);
  shaded = with_haze(picture_colour(colour.rgb * (0.75 * sky + 0.12 * sun * sun_colour.rgb) + own), d);
  scale = depths.w;
  v_look = vec4(colour.a, place.w, depths.xy);
  z = dot(world - eye.xyz, view_forward.xyz);
  gl_Position = clip_from_world * vec4(world, 1.0);
}
