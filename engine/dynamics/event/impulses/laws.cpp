#include "engine/dynamics/event/impulses/laws.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/event/impulses/energetic_impact.hpp"
#include "engine/dynamics/event/impulses/impact_system.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <numeric>

namespace tumble {
namespace {

std::vector<int> all_points(const ImpactSystem& system) {
  std::vector<int> all(size_t(system.points()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

std::vector<int> approaching_points(const ImpactSystem& system) {
  std::vector<int> out;
  for (int i = 0; i < system.points(); ++i)
    if (system.approaching(i)) out.push_back(i);
  return out;
}

double greatest_restitution(const ImpactSystem& system) {
  double most = 0;
  for (int i = 0; i < system.points(); ++i) most = std::max(most, system.point(i).restitution);
  return most;
}

double greatest_approach(const ImpactSystem& system) {
  double most = 0;
  for (int i = 0; i < system.points(); ++i) most = std::max(most, -system.normal_velocity(i));
  return most;
}

/// Stops all points that approach, without restitution.
bool stop_all(ImpactSystem& system, ImpactReport& report) {
  Eigen::VectorXd impulse;
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(system.points());
  if (!system.solve(all_points(system), rest, impulse, report)) return false;
  system.add(impulse);
  return true;
}

/// Runs `law(system, report)` with the checks that all laws share.
template <class Law>
ImpactReport resolve(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                     const Articulation& joints, const Law& law) {
  ImpactReport report;
  ImpactSystem system(blocks, points, joints);
  if (!system.finite()) {
    report.status = ImpactStatus::invalid;
  } else if (law(system, report)) {
    system.finish(blocks, report);
  }
  return report;
}

bool propagate(ImpactSystem& system, ImpactReport& report) {
  const int most = tolerances::most_rounds * system.points();
  for (; report.rounds < most && !stop_requested(); ++report.rounds) {
    charge_work(size_t(system.points()), 2);
    int fastest = -1;
    for (int i = 0; i < system.points(); ++i) {
      if (!system.approaching(i)) continue;
      if (fastest < 0 || system.normal_velocity(i) < system.normal_velocity(fastest)) fastest = i;
    }
    if (fastest < 0) return true;
    const ImpactPoint& p = system.point(fastest);
    const PointImpactResult hit = energetic_impact(
        {system.mobility(fastest), system.velocity(fastest), p.friction, p.restitution});
    if (hit.status != PointImpactStatus::solved) {
      report.status = ImpactStatus::unsolved;
      return false;
    }
    report.solver = "energetic";
    system.add(fastest, hit.impulse);
  }
  if (stop_all(system, report)) return true;
  const double left = greatest_approach(system);
  if (!(left <= tolerances::left_of_series * system.first_speed())) return false;
  report.status = ImpactStatus::solved;
  report.residual = std::max(report.residual, left / system.first_speed());
  return true;
}

bool rebound_once(ImpactSystem& system, std::span<const int> active, ImpactReport& report) {
  Eigen::VectorXd impulse;
  if (!system.rebound(active, impulse, report)) return false;
  system.add(impulse);
  return true;
}

}  // namespace

ImpactReport sequential_impacts(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                                const Articulation& joints) {
  return resolve(blocks, points, joints, propagate);
}

ImpactReport simultaneous_newton(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                                 const Articulation& joints) {
  return resolve(blocks, points, joints, [](ImpactSystem& system, ImpactReport& report) {
    return rebound_once(system, all_points(system), report);
  });
}

ImpactReport simultaneous_poisson(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                                  const Articulation& joints) {
  return resolve(blocks, points, joints, [](ImpactSystem& system, ImpactReport& report) {
    const std::vector<int> all = all_points(system);
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(system.points());
    Eigen::VectorXd compression, stop;
    if (!system.solve(all, rest, compression, report)) return false;
    Eigen::VectorXd expansion = Eigen::VectorXd::Zero(compression.size());
    for (const int i : all) expansion[3 * i] = system.point(i).restitution * compression[3 * i];
    ImpactSystem after = system;
    after.add(compression);
    after.add_friction(expansion, report);
    after.add(expansion);
    if (!after.solve(all, rest, stop, report)) return false;
    expansion += stop;
    system.add(compression + system.harmless_share(compression, expansion, report) * expansion);
    return true;
  });
}

ImpactReport reflections(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                         const Articulation& joints) {
  return resolve(blocks, points, joints, [](ImpactSystem& system, ImpactReport& report) {
    const double bounce = greatest_restitution(system);
    for (int round = 0; round < tolerances::most_rounds && !stop_requested(); ++round) {
      const std::vector<int> active = approaching_points(system);
      if (active.empty()) return true;
      const bool over =
          round >= tolerances::long_series &&
          bounce * greatest_approach(system) <= tolerances::left_of_series * system.first_speed();
      if (bounce == 0 || over) break;
      if (!rebound_once(system, active, report)) return false;
    }
    return stop_all(system, report);
  });
}

const std::vector<ImpactLawEntry>& all_impact_laws() {
  static const std::vector<ImpactLawEntry> list = {
      {"reflections", "all that approach at once, then what approaches after that", reflections},
      {"sequential", "one collision after the other, the fastest first", sequential_impacts},
      {"simultaneous_newton", "all at once, restitution of velocities", simultaneous_newton},
      {"simultaneous_poisson", "all at once, restitution of impulses", simultaneous_poisson},
  };
  return list;
}

}  // namespace tumble
