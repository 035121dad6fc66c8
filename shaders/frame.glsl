// The frame's constants.
layout(std140) uniform Frame {
  mat4 clip_from_world;
  mat4 shadow_from_world;
  vec4 eye;          // xyz [m], far distance [m]
  vec4 view_right;   // xyz: half the picture's width at distance 1
  vec4 view_up;
  vec4 view_forward;
  vec4 to_sun;       // unit
  vec4 sun_colour;   // times intensity
  vec4 zenith;       // light of the sky, times ambient
  vec4 horizon;
  vec4 below;
  vec4 sky_zenith;   // the sky as seen
  vec4 sky_horizon;
  vec4 haze;         // sRGB
  vec4 ground;       // height [m], grid spacing [m], grid on, haze rate [1/m]
  vec4 ground_colour;
  vec4 grid_colour;  // a: strength of the fine lines
  vec4 contact;      // x0, z0 [m], 1/width, 1/depth [1/m]
  vec4 contact_look; // height scale [1/m], strength
  vec4 shadow_look;  // texel in shadow coordinates, normal offset [m], on
  vec4 picture;      // width, height [px], ui scale, exposure
};
#define exposure picture.w
#define haze_rate ground.w
#define low_slope contact_look.x
#define contact_strength contact_look.y
#define shadow_texel shadow_look.x
#define shadows_on shadow_look.z
