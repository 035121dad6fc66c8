#pragma once
#include "engine/dynamics/forces/spring.hpp"
#include "engine/dynamics/forces/spring_mesh.hpp"
#include "engine/dynamics/forces/spring_net.hpp"

#include <span>
#include <vector>

namespace tumble {

/// The springs of a tick.
struct NetSprings {
  std::span<const SpringDef* const> springs;
  std::span<const SpringMeshDef* const> meshes;
};

/// What a mesh does to one of its nodes, as a mean over the tick.
struct NodePull {
  Vec3 force = Vec3::Zero();    ///< [N]
  Vec3 elastic = Vec3::Zero();  ///< the part of it that the potential explains [N]
  Vec3 turn = Vec3::Zero();     ///< moment on a body besides that of the force [N m]
};

struct NetPulls {
  std::vector<SpringNet::Pull> springs;
  std::vector<std::vector<NodePull>> meshes;  ///< of each by node
};

/// What springs do over a tick, each net of connected springs solved by itself and at once:
/// nothing where an end is gone. Other forces must be in the sums by then; the pulls are not added
/// to them. `supported` says by slot, not 0, which bodies contacts or joints held in the tick
/// before: springs expect gravity and other forces to move only what is free; empty: all is.
void pull_springs(const NetSprings& springs, const ForceContext& context,
                  std::span<const uint8_t> supported, NetPulls& out);

/// Adds a pull to the force and torque sums of what the spring is tied to.
void add_pull(const SpringDef& spring, const SpringNet::Pull& pull, ForceContext& context);

}  // namespace tumble
