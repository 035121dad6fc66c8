#pragma once
#include "engine/math/types.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

// Liquids and smoke: what is drawn neither as meshes nor as opaque balls. Flat data, as all of
// RenderScene.

/// A particle of a liquid, whose surface encloses all particles together.
struct FluidParticle {
  Vec3f centre = Vec3f::Zero();
  /// Longest half axis of the ellipsoid by which it contributes to the surface [m].
  float radius = 0.05f;
  float foam = 0;  ///< whiteness of the liquid there, 0..1
  /// Symmetric matrix that maps the ellipsoid to a ball of this radius: xx, yy, zz, xy, xz, yz; no
  /// eigenvalue is below 1 [-].
  std::array<float, 6> to_ball{1, 1, 1, 0, 0, 0};

  /// A lower bound of the shortest half axis, exact if the other two are equal to the radius [m].
  float least_radius() const { return radius / (to_ball[0] + to_ball[1] + to_ball[2] - 2); }
};

/// A liquid with one smooth surface.
struct FluidSurface {
  std::vector<FluidParticle> particles;
  /// Linear colour of white light after `clarity` metres of the liquid.
  Vec3f colour = Vec3f(0.05f, 0.27f, 0.63f);
  float clarity = 1;     ///< [m]
  float radius = 0.05f;  ///< radius of the ball of a typical particle [m]
  /// Volume of liquid per particle over the volume of its ball [-].
  float fill = 1;
};

/// A soft puff of smoke or dust.
struct SmokePuff {
  Vec3f centre = Vec3f::Zero();
  float radius = 0.5f;  ///< the density is zero beyond it [m]
  Vec3f colour = Vec3f(0.6f, 0.6f, 0.6f);
  float opacity = 0.4f;  ///< at the centre, 0..1
  float glow = 0;        ///< emitted light, in units of its colour
  float turn = 0;        ///< rotation about the line of sight [rad]
  /// Arbitrary number that selects the appearance, so that puffs look different.
  uint32_t kind = 0;
};

}  // namespace tumble
