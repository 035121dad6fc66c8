#pragma once
#include "engine/scene/workloads/workload.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

/// The workloads in other engines, with their default settings; nothing sleeps.
namespace tumble::test {

/// A workload, and its bodies at the start: shapes about the centre of mass, mass, inertia.
struct PeerScene {
  const Workload& workload;
  std::span<const RigidBody> bodies;
  static constexpr double step = 1.0 / 60;  ///< [s]
};

class WorkloadPeer {
 public:
  virtual ~WorkloadPeer() = default;
  virtual void step() = 0;
  /// Sets poses and velocities of the scene's bodies to those of now.
  virtual void read(std::span<RigidBody> bodies) = 0;
  virtual size_t contact_points() const = 0;
};

/// Bullet, single precision, as Debian builds it. Moving meshes by GImpact.
std::unique_ptr<WorkloadPeer> bullet_workload(const PeerScene& scene);
/// ODE, double precision: QuickStep, at most eight contacts a pair of shapes.
std::unique_ptr<WorkloadPeer> ode_workload(const PeerScene& scene);
/// MuJoCo: Newton's method, pyramidal cones, semi-implicit Euler. Throws std::runtime_error when it
/// refuses. Null for what it cannot hold: meshes, and more than 150 moving bodies, whose dense
/// matrices it would factor for seconds in every step.
std::unique_ptr<WorkloadPeer> mujoco_workload(const PeerScene& scene);

}  // namespace tumble::test
