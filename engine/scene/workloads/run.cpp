#include "engine/scene/workloads/run.hpp"

#include "engine/core/elapsed.hpp"
#include "engine/core/profiler.hpp"
#include "engine/math/det/det.hpp"
#include "engine/scene/workloads/parts.hpp"
#include "engine/scene/workloads/peak_memory.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace tumble {
namespace {

using Clock = std::chrono::steady_clock;

/// Processor time of all threads of this process [s].
double processor_seconds() {
  return double(std::clock()) / CLOCKS_PER_SEC;
}

/// Sums over the steps of a run.
class Tally {
 public:
  void add(const StepStats& stats, double wall, double cpu) {
    wall_.push_back(1e3 * wall);
    cpu_.push_back(1e3 * cpu);
    pairs_ += double(stats.pairs);
    contacts_ += double(stats.contacts);
    points_ += double(stats.contact_points);
    for (const StageTime& s : stats.stages) stages_.add(s.name, s.seconds);
  }
  void give(WorkloadRun& run) const {
    run.steps = int(wall_.size());
    run.wall = step_times(wall_);
    run.cpu = step_times(cpu_);
    const double steps = std::max(1.0, double(run.steps));
    for (const StageTime& s : stages_.stages())
      run.stages.push_back({std::string(s.name), 1e3 * s.seconds / steps});
    run.pairs = pairs_ / steps;
    run.contacts = contacts_ / steps;
    run.contact_points = points_ / steps;
  }

 private:
  std::vector<double> wall_, cpu_;
  Profiler stages_;
  double pairs_ = 0, contacts_ = 0, points_ = 0;
};

Status run_steps(World& world, int steps, const WorkloadOptions& options, Tally& tally) {
  const auto start = Clock::now();
  world.stop_with(options.stop);
  for (int i = 0; i < steps; ++i) {
    const double begin = seconds_since(start), cpu_begin = processor_seconds();
    const auto report = world.step();
    const double wall = seconds_since(start) - begin, cpu = processor_seconds() - cpu_begin;
    if (!report) return report.error();
    tally.add(report->stats, wall, cpu);
    if (options.each) options.each(*report, begin, wall);
  }
  return {};
}

/// A particle in the form used to measure overlap and energy: a solid ball with its mass.
RigidBody ball_of(const ParticleSystem& p, size_t i) {
  const double r = p.radius[i];
  BodyDef def = sphere_body(p.x[i], r);
  def.shapes[0].material.density = p.mass[i] / (4.0 / 3.0 * det::pi * r * r * r);
  RigidBody ball = make_body(def).value();
  ball.v = p.v[i];
  if (p.grains) ball.omega = p.spin[i];
  return ball;
}

}  // namespace

StepTimes step_times(std::vector<double> t) {
  if (t.empty()) return {};
  std::sort(t.begin(), t.end());
  StepTimes out;
  for (const double x : t) out.mean += x / double(t.size());
  out.median = t[t.size() / 2];
  out.p95 = t[t.size() * 95 / 100];
  out.most = t.back();
  return out;
}

std::vector<RigidBody> WorkloadWorld::states() const {
  std::vector<RigidBody> out;
  for (const BodyId id : bodies) out.push_back(*world->body(id));
  for (const ParticleSystemId id : particles) {
    const ParticleSystem& p = *world->particles(id);
    for (size_t i = 0; i < p.size(); ++i) out.push_back(ball_of(p, i));
  }
  return out;
}

Result<WorkloadWorld> build_workload(const Workload& w, const WorldDef& def) {
  auto world = World::create(def);
  if (!world) return world.error();
  WorkloadWorld out;
  out.world = std::move(*world);
  for (const BodyDef& body : w.bodies) {
    const auto id = out.world->create_body(body);
    if (!id) return id.error();
    out.bodies.push_back(*id);
  }
  for (const WorkloadJoint& j : w.joints) {
    JointDef joint;
    joint.kind = j.kind;
    joint.a = out.bodies[j.a];
    joint.b = out.bodies[j.b];
    joint.frame_a = w.bodies[j.a].pose.inverse() * j.frame;
    joint.frame_b = w.bodies[j.b].pose.inverse() * j.frame;
    if (const auto id = out.world->create_joint(joint); !id) return id.error();
  }
  for (const ParticleSystemDef& system : w.particles) {
    const auto id = out.world->create_particles(system);
    if (!id) return id.error();
    out.particles.push_back(*id);
  }
  if (Status s = out.world->apply_commands(); !s) return s.error();
  return out;
}

Result<WorkloadRun> run_workload(const Workload& w, const WorkloadOptions& options) {
  restart_peak_memory();
  WorldDef def;
  def.settings = options.settings;
  def.threads = options.threads;
  def.log = options.log;
  const auto built = build_workload(w, def);
  if (!built) return built.error();
  Tally tally;
  const Status done = run_steps(*built->world, options.steps.value_or(w.steps), options, tally);
  if (!done) return done.error();

  WorkloadRun run;
  run.workload = w.name;
  run.small = w.small;
  run.threads = options.threads;
  tally.give(run);
  run.peak_memory = peak_memory();
  for (const BodyDef& b : w.bodies) run.bodies += b.type == BodyType::dynamic ? 1 : 0;
  run.joints = w.joints.size();
  for (const ParticleSystemDef& system : w.particles) run.particles += system.particles.size();
  run.memory = built->world->memory_use();
  run.last_contacts = built->world->frame()->stats.contacts;
  run.end = measure_end_state(w, built->states());
  run.state_hash = built->world->state_hash();
  return run;
}

}  // namespace tumble
