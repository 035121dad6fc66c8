#pragma once
#include "engine/core/memory_use.hpp"
#include "engine/core/result.hpp"
#include "engine/scene/workloads/end_state.hpp"
#include "engine/world/frame.hpp"
#include "engine/world/world_def.hpp"

#include <functional>

namespace tumble {

class StopFlag;
struct StepReport;

struct WorkloadOptions {
  WorldSettings settings;
  int threads = 1;           ///< 0: one per core
  std::optional<int> steps;  ///< replaces the workload's number
  /// Passed to the world, see World::stop_with(): a run that is stopped returns an error of code
  /// `cancelled`.
  const StopFlag* stop = nullptr;
  /// Called after every step with its start relative to that of the first one, and its duration
  /// [s].
  std::function<void(const StepReport&, double begin, double seconds)> each;
  LogSink log;
};

/// Times of the steps of a run [ms].
struct StepTimes {
  double mean = 0, median = 0, p95 = 0, most = 0;
};
StepTimes step_times(std::vector<double> milliseconds);

struct StageMean {
  std::string name;
  double milliseconds = 0;  ///< mean per step
};

struct WorkloadRun {
  std::string workload;
  bool small = false;
  int threads = 1;
  int steps = 0;                  ///< done
  StepTimes wall;                 ///< of World::step()
  StepTimes cpu;                  ///< processor time of all threads together
  std::vector<StageMean> stages;  ///< wall time, in the order of the first step that had them
  size_t bodies = 0;              ///< dynamic
  size_t particles = 0;
  size_t joints = 0;
  double pairs = 0, contacts = 0, contact_points = 0;  ///< means per step
  double peak_memory = 0;  ///< of the process, since the bodies were made [MB]; 0: unknown
  MemoryUse memory;        ///< at the end, together with the number of contacts then
  uint64_t last_contacts = 0;
  double bytes_per_body() const { return bodies > 0 ? double(memory.bodies) / double(bodies) : 0; }
  double bytes_per_contact() const {
    return last_contacts > 0 ? double(memory.contacts) / double(last_contacts) : 0;
  }
  double bytes_per_joint() const { return joints > 0 ? double(memory.joints) / double(joints) : 0; }
  EndState end;
  uint64_t state_hash = 0;
};

/// A world with the bodies, joints and particles of a workload; their ids are in its order.
struct WorkloadWorld {
  std::unique_ptr<World> world;
  std::vector<BodyId> bodies;
  std::vector<ParticleSystemId> particles;
  std::vector<RigidBody> states() const;  ///< of the bodies, then of the particles as balls
};
Result<WorkloadWorld> build_workload(const Workload& w, const WorldDef& def);

/// Runs a workload and measures. Errors: those of World::step().
Result<WorkloadRun> run_workload(const Workload& w, const WorkloadOptions& options);

}  // namespace tumble
