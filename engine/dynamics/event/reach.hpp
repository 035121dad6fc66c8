#pragma once
#include "engine/dynamics/bodies/proxies.hpp"

#include <limits>
#include <span>
#include <vector>

namespace tumble {

/// How far the points of a body may come from where they are at the start of a tick, without
/// meeting anything that the body was not paired with.
struct BodyReach {
  Pose start;
  double distance = 0;  ///< of any of its points [m]; 0 for what does not move
  /// Half the edges of a box about the centre of mass, body axes, that holds the body [m]: needles
  /// that spin about themselves go nowhere. Infinite: turning counts with the bounding radius.
  Vec3 half = Vec3::Constant(std::numeric_limits<double>::infinity());
};

/// Whether a body changes its place in a tick: dynamic, or kinematic and not at rest.
bool travels(const RigidBody& body);

/// Greatest speed of any point of a body about its centre and with it, under its force for h
/// seconds [m/s].
double speed_bound(const RigidBody& body, double h);

/// A guess for each body from its speed, its force (which must be set) and `gravity`, the magnitude
/// of what contacts may answer [m/s2]; h seconds.
std::vector<BodyReach> guess_reaches(std::span<const RigidBody> bodies, double gravity, double h);

/// A closer guess for a part of the tick, h seconds of `tick`, from where the body is now.
BodyReach guess_reach(const RigidBody& body, const Vec3& half, double gravity, double h,
                      double tick);

/// BodyReach::half of a body; infinite where its shapes are.
Vec3 box_about(const RigidBody& body);

/// How far the points of a body are from where they started, at most [m].
double displacement_bound(const RigidBody& body, const BodyReach& reach);

/// Bounds of all shapes as far as their bodies may come.
void reach_proxies(std::span<const RigidBody> bodies, std::span<const BodyReach> reaches,
                   ProxySet& out);

}  // namespace tumble
