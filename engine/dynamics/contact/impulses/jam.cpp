#include "engine/dynamics/contact/impulses/jam.hpp"

#include "engine/dynamics/contact/impulses/energetic_impact.hpp"
#include "engine/dynamics/contact/impulses/impact_system.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace tumble {
namespace {

constexpr double slow_slip = 1e-8;       ///< nothing that slides [m/s]
constexpr double small_approach = 1e-9;  ///< of the slip: begins the process
constexpr double changed_slip = 1e-6;    ///< of the fastest slip: more than that approach explains

/// Whether friction against the slip presses more than its normal force parts.
bool presses(const Mat3& mobility, const Vec3& velocity, double friction) {
  const Vec2 slip = velocity.tail<2>();
  const double speed = slip.norm();
  if (!(speed > slow_slip)) return false;
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
  for (int i = 0; i < system.points(); ++i) {
    const double friction = system.point(i).friction;
    Vec3 u = system.velocity(i);
    if (!presses(system.mobility(i), u, friction)) continue;
    u[0] = std::min(u[0], -small_approach * u.norm());
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
                       ImpactReport& report, const Articulation& joints) {
  ImpactSystem system(blocks, points, joints);
  if (!system.finite()) {
    report.status = ImpactStatus::invalid;
    return 0;
  }
  std::vector<int> all(points.size());
  std::iota(all.begin(), all.end(), 0);
  const auto slip_of = [&](int i) -> Vec2 { return system.velocity(i).tail<2>(); };
  std::vector<Vec2> before;
  double fastest = 0;
  for (const int i : all) {
    before.push_back(slip_of(i));
    fastest = std::max(fastest, before.back().norm());
  }
  if (!(fastest > slow_slip)) return 0;
  Eigen::VectorXd impulse;
  const Eigen::VectorXd away =
      Eigen::VectorXd::Constant(Eigen::Index(points.size()), small_approach * fastest);
  if (!system.solve(all, away, impulse, report)) return 0;
  system.add(impulse);
  int jams = 0;
  for (const int i : all) jams += (slip_of(i) - before[size_t(i)]).norm() > changed_slip * fastest;
  if (jams > 0) system.finish(blocks, report);
  return jams;
}

}  // namespace tumble
