#pragma once
#include "engine/dynamics/bodies/proxies.hpp"

#include <limits>
#include <span>
#include <vector>

namespace tumble {

/// How far the points of a body may move from where they are at the start of a tick before the body
/// could meet one that it was not paired with.
struct BodyReach {
  Pose start;
  /// Bound on the displacement of any point; 0 for bodies that do not move [m]
  double distance = 0;
  /// Half the edges of a box about the centre of mass, body axes, that contains the body [m]: by it
  /// the spin of a needle about its own axis moves no point far. Infinite: rotation is bounded by
  /// the bounding radius.
  Vec3 half = Vec3::Constant(std::numeric_limits<double>::infinity());
};

/// Whether a body changes its place in a tick: dynamic, or kinematic and not at rest.
bool travels(const RigidBody& body);

/// Upper bound on the speed of any point of a body during h seconds under its force, with its
/// present rotation [m/s].
double speed_bound(const RigidBody& body, double h);

/// First estimate for each body from its speed, its force (which must be set) and `gravity`, the
/// magnitude of accelerations that contacts may cause [m/s2]; for a tick of h seconds.
std::vector<BodyReach> guess_reaches(std::span<const RigidBody> bodies, double gravity, double h);

/// A closer estimate for a part of a tick: h seconds of `tick`, from the body's present pose.
BodyReach guess_reach(const RigidBody& body, const Vec3& half, double gravity, double h,
                      double tick);

/// BodyReach::half of a body; infinite where its shapes are.
Vec3 box_about(const RigidBody& body);

/// Upper bound on the present displacement of any point of the body from where it started [m].
double displacement_bound(const RigidBody& body, const BodyReach& reach);

/// Bounds of all shapes, inflated by the reach of their bodies.
void reach_proxies(std::span<const RigidBody> bodies, std::span<const BodyReach> reaches,
                   ProxySet& out);

}  // namespace tumble
