#include "engine/dynamics/event/impulses/jam.hpp"

#include "engine/core/stop.hpp"
#include "engine/dynamics/event/impulses/energetic_impact.hpp"
#include "engine/dynamics/event/impulses/impact_system.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace tumble {
namespace {

/// Whether the friction of a normal force accelerates the gap inwards more than the force itself
/// outwards.
bool presses(const Mat3& mobility, const Vec3& velocity, double friction) {
  const Vec2 slip = velocity.tail<2>();
  const double speed = slip.norm();
  if (!(speed > tolerances::jam_slip)) return false;
  const double across = (mobility(0, 1) * slip.x() + mobility(0, 2) * slip.y()) / speed;
  return mobility(0, 0) - friction * across < 0;
}

}  // namespace

int resolve_jams(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                 ImpactReport& report, const Articulation& joints) {
  ImpactSystem system(blocks, points, joints);
  if (!system.finite()) {
    report.status = ImpactStatus::invalid;
    return 0;
  }
  int jams = 0;
  for (int i = 0; i < system.points() && !stop_requested(); ++i) {
    const double friction = system.point(i).friction;
    Vec3 u = system.velocity(i);
    if (!presses(system.mobility(i), u, friction)) continue;
    u[0] = std::min(u[0], -tolerances::jam_approach * u.norm());
    const PointImpactResult stop = energetic_impact({system.mobility(i), u, friction, 0});
    if (stop.status != PointImpactStatus::solved) continue;
    system.add(i, stop.impulse);
    ++jams;
  }
  report.solver = "energetic";
  report.rounds = jams;
  system.finish(blocks, report);
  return jams;
}

int resolve_common_jam(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                       std::span<const Vec3> accelerations, ImpactReport& report,
                       const Articulation& joints) {
  double fastest = 0, greatest = 0;
  {
    const ImpactSystem now(blocks, points, joints);
    if (!now.finite()) {
      report.status = ImpactStatus::invalid;
      return 0;
    }
    for (int i = 0; i < now.points(); ++i)
      fastest = std::max(fastest, now.velocity(i).tail<2>().norm());
  }
  for (const Vec3& a : accelerations) greatest = std::max(greatest, a.norm());
  if (!(fastest > tolerances::jam_slip && greatest > 0)) return 0;
  // Changes of velocity in a negligible time without forces at the points.
  const double soon = tolerances::jam_approach * fastest / greatest;
  std::vector<ImpactPoint> then(points.begin(), points.end());
  for (size_t i = 0; i < then.size(); ++i) {
    const Vec3& n = then[i].normal;
    then[i].surface_velocity -= soon * (accelerations[i] - n.dot(accelerations[i]) * n);
  }
  ImpactSystem system(blocks, then, joints);
  std::vector<int> all(points.size());
  std::iota(all.begin(), all.end(), 0);
  const auto slip_of = [&](int i) -> Vec2 { return system.velocity(i).tail<2>(); };
  std::vector<Vec2> before;
  Eigen::VectorXd target(Eigen::Index(points.size()));
  for (const int i : all) {
    const auto k = size_t(i);
    before.push_back(slip_of(i));
    target[i] = system.normal_velocity(i) - soon * then[k].normal.dot(accelerations[k]);
  }
  Eigen::VectorXd impulse;
  if (!system.solve(all, target, impulse, report)) return 0;
  system.add(impulse);
  int jams = 0;
  for (const int i : all)
    jams += (slip_of(i) - before[size_t(i)]).norm() > tolerances::jam_change * fastest;
  if (jams > 0) system.finish(blocks, report);
  return jams;
}

}  // namespace tumble
