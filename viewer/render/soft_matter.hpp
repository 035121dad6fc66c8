#pragma once
#include "engine/math/types.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

// What is drawn neither as meshes nor as hard balls. Flat data, as all of RenderScene.

/// A particle of a liquid: the surface goes around all of them together.
struct FluidParticle {
  Vec3f centre = Vec3f::Zero();
  float radius = 0.05f;  ///< longest half axis of the ellipsoid that it is for the surface [m]
  float foam = 0;        ///< how white the liquid is there, 0..1
  /// The symmetric matrix that makes a ball of this radius of the ellipsoid: xx, yy, zz, xy, xz,
  /// yz; no eigenvalue is below 1 [-].
  std::array<float, 6> to_ball{1, 1, 1, 0, 0, 0};

  /// No more than the shortest half axis, and equal to it where the others are equal [m].
  float least_radius() const { return radius / (to_ball[0] + to_ball[1] + to_ball[2] - 2); }
};

/// A liquid with one smooth surface.
struct FluidSurface {
  std::vector<FluidParticle> particles;
  Vec3f colour = Vec3f(0.05f, 0.27f, 0.63f);  ///< of light that went through `clarity`, linear
  float clarity = 1;                          ///< [m]
  float radius = 0.05f;                       ///< of a typical particle's ball [m]
  /// How much of the liquid a ball stands for, over the volume of the ball [-].
  float fill = 1;
};

/// A soft puff of smoke or dust.
struct SmokePuff {
  Vec3f centre = Vec3f::Zero();
  float radius = 0.5f;  ///< beyond it there is nothing [m]
  Vec3f colour = Vec3f(0.6f, 0.6f, 0.6f);
  float opacity = 0.4f;  ///< in the middle, 0..1
  float glow = 0;        ///< light that it gives off, in units of its colour
  float turn = 0;        ///< about the line of sight [rad]
  uint32_t kind = 0;     ///< any number: puffs of different ones look different
};

}  // namespace tumble
