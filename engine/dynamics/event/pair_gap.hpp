#pragma once
#include "engine/collision/narrow_phase.hpp"

namespace tumble {

/// The gap of two shapes at one moment.
struct PairGap {
  bool near = false;            ///< at most the margin apart
  double gap = 0;               ///< negative is penetration; not near: a bound [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, from A to B, world axes
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();  ///< nearest or deepest points, world axes [m]
};

/// How far the plane across n separates the shapes [m]: B's least height along n over A's greatest.
/// A lower bound of the gap, negative infinity where a half-space is not across n. Meshes count
/// with their hulls.
double separation_along(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                        const Vec3& n);

/// Whether `pair_gap` knows the two shapes: all but meshes with anything but half-spaces, which
/// have a gap for each of their pieces (pieces.hpp).
bool has_pair_gap(const Shape& a, const Shape& b);

/// The greatest separation of two shapes along any direction, for touching ones to about
/// 1e-12 of their size, which nearest points (whose direction is noise when they meet) and
/// expanding polytopes do not give: B is moved apart along the normal by a hundredth of the smaller
/// shape, the nearest points there say the normal better, and so on until it stays; the points
/// stay too, since a move along the normal keeps nearest points. `towards_b`: where to begin, the
/// normal a little earlier; zero if there is none. Balls against what has a closed form of its
/// nearest points (ConvexShape::nearest) need none of that.
PairGap pair_gap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                 double margin, const Vec3& towards_b);

/// Contacts along the normal of a gap: clipped faces, and its nearest points where none of these is
/// as near.
void pair_manifolds(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                    const ContactQuery& query, const PairGap& gap, NarrowPhase narrow_phase,
                    std::vector<Manifold>& out);

}  // namespace tumble
