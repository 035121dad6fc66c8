#pragma once
#include "engine/collision/shape.hpp"
#include "engine/dynamics/sph/smoothing_kernel.hpp"

#include <optional>

namespace tumble {

/// What a solid is to a particle near it.
struct WallShare {
  double share = 0;              ///< of the kernel about the particle that is in the solid [-]
  Vec3 gradient = Vec3::Zero();  ///< of that, by the particle's place, world axes [1/m]
  double distance = 0;           ///< to the surface, negative inside [m]
  Vec3 normal = Vec3::UnitY();   ///< out of the solid there, unit, world axes
};

/// What takes the place of the neighbours that a particle would have in a wall. Beside a plane wall
/// they are the layers of the particle's own mirror image, half of it as far behind the surface as
/// the particle is before it: what leaves the layers of a fluid at rest half a spacing from the
/// wall, under any pressure, and lets none into it. Of the half-space behind the nearest point, a
/// solid is the part that the kernel's integral over it says (Kulasegaram et al. 2004; Koschier and
/// Bender 2017), which is exact for boxes and balls; other shapes count as plane (Winchenbach et
/// al. 2020). Nothing where the solid is farther than half of the kernel's reach.
std::optional<WallShare> wall_share(const SmoothingKernel& kernel, double spacing,
                                    const Shape& shape, const Pose& pose, const Vec3& x);

/// The half-space by such layers at a signed distance [m] [-], and minus its derivative [1/m].
double mirrored_half_space(const SmoothingKernel& kernel, double spacing, double distance);
double mirrored_plane(const SmoothingKernel& kernel, double spacing, double distance);

/// The exact integrals in a frame of the solid: the box from -e to e, and a ball about the origin.
struct OwnShare {
  double share = 0;
  Vec3 gradient = Vec3::Zero();
};
OwnShare box_share(const SmoothingKernel& kernel, const Vec3& half_extents, const Vec3& x);
OwnShare ball_share(const SmoothingKernel& kernel, double radius, const Vec3& x);

}  // namespace tumble
