#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/joints/joint_kinds.hpp"
#include "engine/dynamics/particles/particle_system.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// A joint between two bodies of a workload, given by their indices.
struct WorkloadJoint {
  JointKind kind = JointKind::spherical;
  size_t a = 0, b = 0;
  Pose frame;  ///< in the world, at the start: origin at the anchor, z along the main axis
};

/// Formulas of the tori of a workload and of their ground, for measurements that need no mesh.
struct ToriOnTerrain {
  double major = 0, minor = 0;  ///< about the body's y axis, see torus_mass() [m]
  double half_width = 0;        ///< the ground extends to |x|, |z| below this [m]
  double (*height)(double x, double z) = nullptr;  ///< of the ground [m]
  /// The mesh of each torus, if tori and ground are meshes, the latter with `cells` x `cells`
  /// squares; null if they are smooth.
  std::shared_ptr<const TriangleMesh> facets;
  int cells = 0;
};

/// A fixed benchmark for comparing versions of the engine, and other engines: a number of steps of
/// 1/60 s with given bodies and joints, under gravity of 9.81 m/s2, with friction 0.5 and
/// restitution 0 everywhere; no body sleeps. All its numbers are part of the definition.
struct Workload {
  std::string_view name;
  bool small = false;
  int steps = 0;
  std::vector<BodyDef> bodies;
  std::vector<WorkloadJoint> joints;
  std::vector<ParticleSystemDef> particles;
  bool collides = true;  ///< whether any two of its bodies may touch
  std::optional<ToriOnTerrain> tori;
};

/// One entry of the list of workloads. The small variant is for other engines that cannot run the
/// full one, and for tests.
struct WorkloadEntry {
  std::string_view name;
  std::string_view doc;
  Workload (*make)(bool small);
};

/// W1 to W9 in their order.
const std::vector<WorkloadEntry>& all_workloads();
/// The workload of an entry, with its name.
Workload make_workload(const WorkloadEntry& entry, bool small = false);

}  // namespace tumble
