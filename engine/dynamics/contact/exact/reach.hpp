#pragma once
#include "engine/dynamics/rigid/proxies.hpp"

#include <span>
#include <vector>

namespace tumble {

/// How far the points of a body may come from where they are at the start of a tick, without
/// meeting anything that the body was not paired with.
struct BodyReach {
  Pose start;
  double distance = 0;  ///< of any of its points [m]; 0 for what does not move
};

/// Whether a body changes its place in a tick: dynamic, or kinematic and not at rest.
bool travels(const RigidBody& body);

/// Greatest speed of any point of a body about its centre and with it, under its force for h
/// seconds [m/s].
double speed_bound(const RigidBody& body, double h);

/// A guess for each body from its speed, its force (which must be set) and `gravity`, the magnitude
/// of what contacts may answer [m/s2]; h seconds.
std::vector<BodyReach> guess_reaches(std::span<const RigidBody> bodies, double gravity, double h);

/// How far the points of a body are from where they started, at most [m].
double distance_gone(const RigidBody& body, const BodyReach& reach);

/// What a body needs that has left its reach with `left` seconds of the tick to go.
double wider_reach(const RigidBody& body, const BodyReach& reach, double left);

/// Bounds of all shapes as far as their bodies may come.
void reach_proxies(std::span<const RigidBody> bodies, std::span<const BodyReach> reaches,
                   ProxySet& out);

}  // namespace tumble
