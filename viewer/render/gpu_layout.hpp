#pragma once
#include <array>
#include <cstddef>
#include <span>

namespace tumble {

// Contents of buffers, byte for byte as the shaders read them.

struct GpuVertex {
  std::array<float, 3> position;
  std::array<float, 3> normal;
};

struct GpuInstance {
  std::array<std::array<float, 4>, 3> rows;  ///< world from mesh, 3 x 4, rows
  std::array<float, 4> colour;
  std::array<float, 4> look;     ///< roughness, metallic, emission, inflate
  std::array<float, 4> pattern;  ///< kind, strength, size, shift
};
static_assert(sizeof(GpuInstance) == 96);

struct GpuLine {
  std::array<float, 3> a, b;
  std::array<float, 4> colour;
  float width;
};
static_assert(sizeof(GpuLine) == 44);

struct GpuPoint {
  std::array<float, 3> x;
  std::array<float, 4> colour;
  float size;
};
static_assert(sizeof(GpuPoint) == 32);

/// One of the three equal vertices of a particle's triangle; the shader tells them apart by
/// gl_VertexID.
struct GpuSphere {
  std::array<float, 3> centre;
  float radius;
  std::array<float, 4> colour;
};
static_assert(sizeof(GpuSphere) == 32);

/// A particle of a liquid; see FluidParticle.
struct GpuFluidParticle {
  std::array<float, 3> centre;
  float radius;
  std::array<float, 6> to_ball;
  float foam;
  float unused;
};
static_assert(sizeof(GpuFluidParticle) == 48);

/// A puff of smoke: one instance of a square.
struct GpuPuff {
  std::array<float, 4> place;   ///< centre, radius [m]
  std::array<float, 4> colour;  ///< linear, opacity
  /// Share of the sunlight that reaches it, glow, cosine and sine of its rotation.
  std::array<float, 4> look;
  std::array<float, 2> corner;  ///< corner of its picture in the atlas
};
static_assert(sizeof(GpuPuff) == 56);

/// The uniform block Soft of shaders/soft.glsl (std140), for liquids and the shadow that liquids
/// and smoke cast (SunVeil).
struct GpuSoft {
  std::array<float, 16> veil_from_world;  ///< maps the veil to 0..1; depth grows away from the sun
  std::array<float, 4> veil;    ///< 1 / softness of its front boundary, then pixels of the picture
                                ///< per pixel of its shade
  std::array<float, 4> depths;  ///< near, far [m], pixels per unit at distance 1, pixels of the
                                ///< picture per texel of smoke
  std::array<float, 4> absorb;  ///< absorption [1/m], then thickness per length of a chord [-]
  std::array<float, 4> body;    ///< colour, greatest foam
  std::array<float, 4> smooth;  ///< reach, range that is smoothed, step for what is behind it [m],
                                ///< greatest reach [texels]
  std::array<float, 4> ball;    ///< radius of a ball [m], unused
};
static_assert(sizeof(GpuSoft) == 64 + 6 * 16);

/// The uniform block Frame of shaders/common.glsl (std140).
struct GpuFrame {
  std::array<float, 16> clip_from_world;
  std::array<float, 16> shadow_from_world;
  std::array<float, 4> eye, view_right, view_up, view_forward;
  std::array<float, 4> to_sun, sun_colour, zenith, horizon, below, sky_zenith, sky_horizon, haze;
  std::array<float, 4> ground, ground_colour, grid_colour;
  std::array<float, 4> contact, contact_look, shadow_look, picture;
};
static_assert(sizeof(GpuFrame) == 2 * 64 + 19 * 16);

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span<const T, 1>(&value, 1));
}

}  // namespace tumble
