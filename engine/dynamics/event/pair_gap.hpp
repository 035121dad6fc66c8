#pragma once
#include "engine/collision/narrow_phase.hpp"

namespace tumble {

/// The gap of two shapes at one moment.
struct PairGap {
  bool near = false;            ///< at most the margin apart
  double gap = 0;               ///< negative is penetration; if not near, a lower bound [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, from A to B, world axes
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();  ///< nearest or deepest points, world axes [m]
};

/// Separation of the shapes by planes across n: B's least height along n less A's greatest [m]. A
/// lower bound of the gap; negative infinity where n is not along the normal of a half-space.
/// Meshes count as their convex hulls.
double separation_along(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                        const Vec3& n);

/// Whether pair_gap() is defined for the two shapes: all but meshes, except with half-spaces;
/// meshes have a gap for each of their pieces (pieces.hpp).
bool has_pair_gap(const Shape& a, const Shape& b);

/// The greatest separation of two shapes along any direction, accurate for touching shapes to about
/// 1e-12 of their size. Nearest points (whose direction is noise at contact) and expanding
/// polytopes are less accurate. So B is moved apart along the normal by a hundredth of the smaller
/// shape's size, the nearest points there give a better normal, and this is repeated until the
/// normal stays; the nearest points stay too, since a displacement along the normal does not change
/// them. `towards_b`: the normal at a slightly earlier time, as a start; zero if unknown. Balls
/// against shapes with a closed form of nearest points (ConvexShape::nearest) do not need this.
PairGap pair_gap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                 double margin, const Vec3& towards_b);

/// Contact points along the normal of a gap: those of clipped faces, and the nearest points where
/// no other point is as near.
void pair_manifolds(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                    const ContactQuery& query, const PairGap& gap, NarrowPhase narrow_phase,
                    std::vector<Manifold>& out);

}  // namespace tumble
