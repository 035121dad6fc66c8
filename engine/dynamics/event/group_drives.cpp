#include "engine/dynamics/event/group_drives.hpp"

#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// The row, directed away from a limit.
Row row_inwards(const DrivePart& limit, const Row& along) {
  Row out = along;
  for (RowSide* s : {&out.a, &out.b}) {
    s->linear *= limit.inwards();
    s->angular *= limit.inwards();
  }
  return out;
}

}  // namespace

std::vector<double> GroupDrives::start_joints(std::vector<DofBlock>& moving) {
  Articulation& joints = state_.system.joints();
  if (joints.empty()) return {};
  drives().follow(state_.bodies, state_.system.now());
  drives().stop_motors(state_.bodies, state_.system.now(), joints);
  joints.look_where_moved(state_.bodies, state_.system.now());
  moving.resize(state_.group.bodies.size());
  put_velocities(state_.bodies, state_.group.bodies, moving);
  const auto off = [&](size_t row) {
    return joints.held()[row].use != RowUse::armature &&
           std::fabs(joints.rate_off(row, moving)) > tolerances::still_speed;
  };
  bool any = false;
  for (size_t i = 0; i < joints.size() && !any; ++i) any = off(i);
  if (!any) return {};
  moving = state_.blocks();
  state_.joints_now();
  std::vector<double> impulses(joints.size());
  joints.hold_velocities(moving, impulses);
  return impulses;
}

std::vector<size_t> GroupDrives::touching() const {
  std::vector<size_t> out;
  const std::span<const DrivePart> parts = drives().parts();
  for (size_t i = 0; i < parts.size(); ++i)
    if (parts[i].limit() && room(parts[i]) <= (parts[i].holds ? tolerances::closed_distance
                                                              : tolerances::touch_distance))
      out.push_back(i);
  return out;
}

bool GroupDrives::hit(std::span<const size_t> touching) const {
  return std::ranges::any_of(touching, [&](size_t i) {
    const DrivePart& p = drives().parts()[i];
    return rate_off(p) < -(p.holds ? tolerances::still_speed : tolerances::collision_speed);
  });
}

bool GroupDrives::ends_series(const DrivePart& p, double approach) const {
  if (p.impacts <= tolerances::many_impacts) return false;
  const std::vector<DofBlock> moving = state_.blocks();
  state_.system.set_contacts(state_.contacts);
  const std::vector<double> y = state_.system.read(state_.now);
  std::vector<double> rates(y.size());
  const bool found = state_.system.derivative(state_.now, y, rates);
  state_.set_velocities(moving);
  if (!found) return true;
  const JointRow at = drives().look(p.of, state_.bodies, state_.system.now());
  const double back = std::fabs(row_velocity(at.row, state_.system.accelerations()) + at.bias);
  return approach < tolerances::zeno_of_gravity_tick * back * state_.part.tick;
}

double GroupDrives::add_points(std::span<const size_t> touching, std::vector<ImpactPoint>& points) {
  double fastest = 0;
  for (const size_t i : touching) {
    DrivePart& p = drives().parts()[i];
    const double approach = -rate_off(p);
    ImpactPoint& q = points.emplace_back();
    q.along = row_inwards(p, row(p));
    q.restitution = p.restitution;
    fastest = std::max(fastest, approach);
    if (approach <= tolerances::collision_speed) continue;
    const bool still = approach < tolerances::still_speed;
    p.impacts += !still;
    if (still || ends_series(p, approach)) q.restitution = 0;
  }
  return fastest;
}

void GroupDrives::add_velocities(std::vector<Row>& rows, std::vector<double>& wanted) const {
  for (const DrivePart& p : drives().parts()) {
    if (!p.holds || p.saturated()) continue;
    rows.push_back(row(p));
    wanted.push_back(-(p.limit() ? p.inwards() : 1) * rate_off(p));
  }
}

void GroupDrives::add_positions(std::vector<Row>& rows, std::vector<double>& wanted) const {
  for (const DrivePart& p : drives().parts()) {
    if (!p.limit()) continue;
    const double left = room(p);
    if (!p.holds && !(left < -tolerances::touch_distance)) continue;
    rows.push_back(row(p));
    wanted.push_back(-p.inwards() * left);
  }
}

bool GroupDrives::kept() const {
  return std::ranges::none_of(drives().parts(), [&](const DrivePart& p) {
    if (!p.holds || p.force == 0 || p.saturated()) return false;
    const double share = tolerances::kept_closed_share;
    return std::fabs(rate_off(p)) > share * tolerances::still_speed ||
           (p.limit() && std::fabs(room(p)) > share * tolerances::closed_distance);
  });
}

}  // namespace tumble
