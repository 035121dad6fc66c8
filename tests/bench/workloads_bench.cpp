// The workloads W1 to W8 (engine/scene/workloads) in Tumble and in Bullet, ODE (QuickStep) and, the
// small variants, MuJoCo: processor time of a step, its ratio to Bullet's, and what is left at the
// end, measured alike for all from their poses; where bodies are meshes also with distance fields
// in place of what moves. All engines advance by blocks of steps in turn, so that each sees the
// same machine. `bench_workloads [--small] [--steps N] [--threads N] [NAME...]`;
// --threads is ours. Without --small every workload is followed by its small variant if MuJoCo can
// hold that.
#include "engine/scene/workloads/run.hpp"
#include "engine/world/world.hpp"
#include "tests/bench/contest.hpp"
#include "tests/bench/workloads/peers.hpp"

#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include <fmt/format.h>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr int block = 20;  ///< steps in a row

struct Options {
  bool small_only = false;
  int steps = 0;  ///< 0: the workload's own
  int threads = 1;
  std::vector<std::string> names;
};

/// Tumble as one of the engines.
class OurWorkload final : public WorkloadPeer {
 public:
  OurWorkload(const PeerScene& scene, int threads) {
    WorldDef def;
    def.threads = threads;
    auto built = build_workload(scene.workload, def);
    if (!built) throw std::runtime_error(built.error().text());
    built_ = std::move(*built);
  }
  void step() override {
    if (const auto report = built_.world->step(); !report)
      throw std::runtime_error(report.error().text());
  }
  void read(std::span<RigidBody> bodies) override {
    const std::vector<RigidBody> now = built_.states();
    std::copy(now.begin(), now.end(), bodies.begin());
  }
  size_t contact_points() const override { return built_.world->frame()->stats.contact_points; }

 private:
  WorkloadWorld built_;
};

/// The same with a distance field for every mesh that moves.
Workload with_fields(Workload w) {
  for (BodyDef& b : w.bodies)
    for (BodyShapeDef& s : b.shapes)
      if (b.type == BodyType::dynamic && s.shape.type == ShapeType::triangle_mesh)
        s.shape.type = ShapeType::distance_field;
  return w;
}

struct Competitor {
  std::string name;
  std::unique_ptr<WorkloadPeer> engine;
  std::vector<double> cpu, wall;  ///< of each block, a step [ms]
  std::string failure;
};

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return values.empty() ? 0 : sum / double(values.size());
}

void advance(Competitor& who, int steps) {
  if (!who.failure.empty()) return;
  const auto start = std::chrono::steady_clock::now();
  const double cpu = bench::processor_milliseconds();
  try {
    for (int i = 0; i < steps; ++i) who.engine->step();
  } catch (const std::runtime_error& e) {
    who.failure = e.what();
    return;
  }
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  who.cpu.push_back((bench::processor_milliseconds() - cpu) / steps);
  who.wall.push_back(spent.count() / steps);
}

std::vector<Competitor> competitors(const PeerScene& scene, int threads) {
  std::vector<Competitor> out;
  const auto add = [&out](std::string name, std::unique_ptr<WorkloadPeer> engine) {
    if (engine) out.push_back({std::move(name), std::move(engine), {}, {}, {}});
  };
  add("Bullet", bullet_workload(scene));
  add("Tumble", std::make_unique<OurWorkload>(scene, threads));
  if (scene.workload.tori && scene.workload.tori->facets) {
    const Workload fields = with_fields(scene.workload);
    add("with fields", std::make_unique<OurWorkload>(PeerScene{fields, scene.bodies}, threads));
  }
  add("ODE quick", ode_workload(scene));
  if (scene.workload.small) add("MuJoCo", mujoco_workload(scene));
  return out;
}

void print_row(const Competitor& who, double peer_cpu, const Workload& w,
               std::vector<RigidBody> bodies) {
  if (!who.failure.empty()) {
    fmt::print("  {:<12} failed: {}\n", who.name, who.failure);
    return;
  }
  who.engine->read(bodies);
  const EndState end = measure_end_state(w, bodies);
  fmt::print(
      "  {:<12}{:>10.3f}{:>8.3f}{:>10.3f}{:>9}{:>10.2f}{:>9.3f}{:>9.1f}{:>9.3f}{:>11.4g}{:>6}\n",
      who.name, mean(who.cpu), mean(who.cpu) / peer_cpu, mean(who.wall),
      who.engine->contact_points(), 1e3 * end.overlap.deepest, 1e3 * end.overlap.mean(),
      1e3 * end.joint_gap, end.fastest, end.kinetic_energy, end.escaped);
}

/// Runs one workload in all engines; gives our processor time over Bullet's.
double run_one(const Workload& w, const Options& options) {
  const std::vector<RigidBody> start = bodies_at_start(w);
  const PeerScene scene{w, start};
  std::vector<Competitor> all = competitors(scene, options.threads);
  const int steps = options.steps > 0 ? options.steps : w.steps;
  fmt::print("{}{}, {} bodies, {} joints, {} steps\n", w.name, w.small ? " small" : "",
             start.size(), w.joints.size(), steps);
  fmt::print("  {:<12}{:>10}{:>8}{:>10}{:>9}{:>10}{:>9}{:>9}{:>9}{:>11}{:>6}\n", "", "cpu ms",
             "ratio", "wall ms", "points", "deep mm", "mean mm", "gap mm", "m/s", "J", "lost");
  for (int done = 0; done < steps; done += block)
    for (Competitor& who : all) advance(who, std::min(block, steps - done));
  for (const Competitor& who : all) print_row(who, mean(all[0].cpu), w, start);
  std::fflush(stdout);
  return mean(all[1].cpu) / mean(all[0].cpu);
}

Options parse(int count, char** words) {
  Options out;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    if (word == "--small")
      out.small_only = true;
    else if (word == "--steps" && i + 1 < count)
      out.steps = std::atoi(words[++i]);
    else if (word == "--threads" && i + 1 < count)
      out.threads = std::atoi(words[++i]);
    else
      out.names.push_back(word);
  }
  return out;
}

}  // namespace

int main(int count, char** words) {
  const Options options = parse(count, words);
  std::string ratios;
  for (const WorkloadEntry& entry : all_workloads()) {
    const bool wanted =
        options.names.empty() ||
        std::find(options.names.begin(), options.names.end(), entry.name) != options.names.end();
    if (!wanted) continue;
    if (!make_workload(entry, true).particles.empty()) {
      fmt::print("{}: grains, which none of these peers has: see tumble bench\n", entry.name);
      continue;
    }
    if (!options.small_only)
      ratios += fmt::format("  {:<5}{:>8.3f}\n", entry.name,
                            run_one(make_workload(entry, false), options));
    const Workload small = make_workload(entry, true);
    if (options.small_only || !small.tori) (void)run_one(small, options);
  }
  if (!ratios.empty()) fmt::print("Tumble's processor time over Bullet's\n{}", ratios);
}
