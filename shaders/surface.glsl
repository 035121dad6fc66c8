// Light on bodies. FINE: every sample of shadow and contact shade; else what a processor can bear.
#include "common.glsl"
#include "shading.glsl"
in vec3 world;
in vec3 world_normal;
in vec3 body;
flat in vec4 v_colour;
flat in vec4 v_look;
flat in vec4 v_pattern;
out vec4 picture_out;

// Sign of x with an edge one pixel wide.
float soft_sign(float x) {
  return clamp(x / max(fwidth(x), 1e-6), -1.0, 1.0);
}
float wave(float x) {  // +-1, period 2, soft edges
  return soft_sign(abs(fract(0.5 * x) * 2.0 - 1.0) - 0.5);
}
float pattern_tone() {
  float second = 0.0;
  if (v_pattern.x < 1.5) second = soft_sign(body.x) * soft_sign(body.y) * soft_sign(body.z);
  else if (v_pattern.x < 2.5) second = wave((body.x - v_pattern.w) / v_pattern.z);
  else {
    vec3 p = body / v_pattern.z + 0.013;
    second = wave(p.x) * wave(p.y) * wave(p.z);
  }
  return 1.0 - v_pattern.y * (0.5 - 0.5 * second);
}

void main() {
  vec3 n = normalize(gl_FrontFacing ? world_normal : -world_normal);
  vec3 to_eye = eye.xyz - world;
  float d2 = dot(to_eye, to_eye);
  float inv_d = inversesqrt(d2);
  vec3 v = to_eye * inv_d;
  vec3 l = to_sun.xyz;
  vec3 base = v_colour.rgb;
  if (v_pattern.x > 0.5) base *= pattern_tone();

  float ndl = max(dot(n, l), 0.0);
  float ndv = max(dot(n, v), 0.0);
#ifdef FINE
  float lit = ndl * sun_visibility(world, n);
  float shade = contact_shade(world, 0.5 - 0.5 * n.y);
#else
  float lit = ndl * sun_visibility_cheap(world, n);
  float shade = low_shade(world.y, 0.5 - 0.5 * n.y);
#endif

  // GGX with Schlick's Fresnel and the visibility term of Karis (SIGGRAPH 2013).
  vec3 h = normalize(l + v);
  float ndh = max(dot(n, h), 0.0), vdh = max(dot(v, h), 0.0);
  float a = v_look.x * v_look.x, a2 = a * a;
  float q = ndh * ndh * (a2 - 1.0) + 1.0;
  float k = 0.5 * a;
  float vis = 0.25 / ((ndl * (1.0 - k) + k) * (ndv * (1.0 - k) + k) + 1e-4);
  float f1 = 1.0 - vdh, f2 = f1 * f1;
  vec3 f0 = mix(vec3(0.04), base, v_look.y);
  vec3 fresnel = f0 + (1.0 - f0) * (f2 * f2 * f1);
  vec3 specular = fresnel * min(a2 / (q * q + 1e-6) * vis, 8.0);

  // The sky mirrored at grazing angles: the rim that lifts bodies off the background.
  vec3 r = reflect(-v, n);
  float e1 = 1.0 - ndv, e2 = e1 * e1;
  vec3 rim = (f0 + (max(vec3(1.0 - v_look.x), f0) - f0) * (e2 * e2 * e1));
  vec3 diffuse = base * (1.0 - v_look.y);
  vec3 radiance = (diffuse + specular) * lit * sun_colour.rgb +
                  (diffuse * sky_light(n.y) + rim * sky_light(r.y)) * shade + base * v_look.z;
  picture_out = vec4(with_haze(picture_colour(radiance), d2 * inv_d), v_colour.a);
}
