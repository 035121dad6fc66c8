// Light on bodies. FINE: every sample of shadow and contact shade; else what a processor can bear.
#include "shading.glsl"

// Where a point of a body is, as seen from it.
struct Place {
  vec3 to_eye;     // [m]
  vec3 in_shadow;  // in the shadow map
  vec3 on_ground;  // in the contact map, and its lowness
};

// Radiance of a point: what its matter sends back, and what it mirrors.
struct Reflected {
  vec3 matter, sparkle, sky;  // of the sky as if all of it came back
  vec3 mirrors;               // share of the sky that does
  float distance;             // from the eye [m]
};

// Of a point with unit normal n; look: roughness, metallic, emission.
Reflected light_of(Place place, vec3 n, vec3 base, vec3 look) {
  float d2 = dot(place.to_eye, place.to_eye);
  float inv_d = inversesqrt(d2);
  vec3 v = place.to_eye * inv_d;
  vec3 l = to_sun.xyz;
  float nl = dot(n, l), nv = dot(n, v), lv = dot(l, v);
  float ndl = max(nl, 0.0), ndv = max(nv, 0.0);
#ifdef FINE
  float lit = ndl * sun_visibility(place.in_shadow);
  float shade = contact_shade(place.on_ground.xy, place.on_ground.z, 0.5 - 0.5 * n.y);
#else
  float lit = ndl * sun_visibility_cheap(place.in_shadow);
  float shade = low_shade(place.on_ground.z, 0.5 - 0.5 * n.y);
#endif

  // GGX with Schlick's Fresnel and the visibility term of Karis (SIGGRAPH 2013).
  // The half vector is (l + v) / |l + v|, and |l + v|^2 = 2 + 2 l.v.
  float by_h = inversesqrt(max(2.0 + 2.0 * lv, 1e-6));
  float ndh = max((nl + nv) * by_h, 0.0), vdh = (1.0 + lv) * by_h;
  float a = look.x * look.x, a2 = a * a;
  float q = ndh * ndh * (a2 - 1.0) + 1.0;
  float k = 0.5 * a;
  float by_vis = 4.0 * ((ndl * (1.0 - k) + k) * (ndv * (1.0 - k) + k) + 1e-4);
  float f1 = 1.0 - vdh, f2 = f1 * f1;
  vec3 f0 = mix(vec3(0.04), base, look.y);
  vec3 fresnel = f0 + (1.0 - f0) * (f2 * f2 * f1);
  vec3 specular = fresnel * min(a2 / ((q * q + 1e-6) * by_vis), 8.0);

  // The sky mirrored at grazing angles: the rim that lifts bodies off the background.
  float e1 = 1.0 - ndv, e2 = e1 * e1;
  vec3 rim = f0 + (max(vec3(1.0 - look.x), f0) - f0) * (e2 * e2 * e1);
  // Metals have nothing but mirrored light: the bright sky around the sun keeps them from being dull.
  float glow = max(2.0 * nv * nl - lv, 0.0);
  vec3 mirrored = sky_light(2.0 * nv * n.y - v.y) * (1.0 + look.y) + (0.5 * look.y * glow * glow) * sun_colour.rgb;
  vec3 diffuse = base * (1.0 - look.y);
  return Reflected(diffuse * (lit * sun_colour.rgb + shade * sky_light(n.y)) + base * look.z,
               specular * lit * sun_colour.rgb, shade * mirrored, rim, d2 * inv_d);
}

// Picture colour of a point with unit normal n; look: roughness, metallic, emission.
vec3 lit_picture_colour(Place place, vec3 n, vec3 base, vec3 look) {
  Reflected light = light_of(place, n, base, look);
  return with_haze(picture_colour(light.matter + light.sparkle + light.mirrors * light.sky),
                   light.distance);
}

// The same, times how much it covers, of what is seen through: its opacity is that of the matter, what
// it mirrors of the sky lies over that, and the sun over all. No layer is brighter than it covers, so
// that nothing has to be cut off where they are laid over others.
vec4 lit_glass(Place place, vec3 n, vec3 base, float opacity, vec3 look) {
  Reflected light = light_of(place, n, base, look);
  vec3 through = 1.0 - light.mirrors;
  vec3 matter = opacity * through * with_haze(picture_colour(light.matter), light.distance);
  vec3 mirror = light.mirrors * with_haze(picture_colour(light.sky), light.distance);
  float left = (1.0 - opacity) * min(through.r, min(through.g, through.b));
  vec3 sparkle = picture_colour(light.sparkle);
  float beside = 1.0 - max(sparkle.r, max(sparkle.g, sparkle.b));
  return vec4(sparkle + beside * (matter + mirror), 1.0 - beside * left);
}
