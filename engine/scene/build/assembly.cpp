#include "engine/scene/build/assembly.hpp"

#include "engine/core/stop.hpp"
#include "engine/math/rotation.hpp"
#include "engine/scene/build/jointed_bodies.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// A joint counts as closed if its error is below this, relative to the distances in the scene, or
/// to a metre and a radian [-]: a few thousand roundings. Likewise for velocities.
constexpr double closed = 1e-12;
/// Newton's method continues while it makes progress, down to this error: where it converges, it
/// reaches rounding.
constexpr double closed_well = 1e-14;
/// Smaller displacements are not reported [m, rad, m/s, rad/s].
constexpr double not_told = 1e-9;
/// Greatest number of Newton steps; far from a solution, a step is limited to this rotation of a
/// body [rad].
constexpr int most_steps = 200;
constexpr double longest_turn = 0.5;
/// Greatest number of halvings of a step before giving up.
constexpr int most_halvings = 30;
/// Greatest number of rounds in which violated limits are added.
constexpr int most_limit_rounds = 20;

struct BodyStart {
  Pose pose;
  Vec3 v, omega;
};

class Assembly {
 public:
  explicit Assembly(const BuiltScene& built)
      : held_(built), slots_(first_numbers(held_.bodies.size())) {
    for (const RigidBody& b : held_.bodies) {
      start_.push_back({b.pose, b.v, b.omega});
      size_ = std::max(size_, b.pose.x.norm());
    }
  }

  /// Closes all joints; false if some remain open.
  bool close_all() {
    for (int round = 0; round < most_limit_rounds && !stop_requested(); ++round) {
      renew_rows();
      if (!close_joints()) return false;
      if (!add_passed_limits()) return true;
    }
    return false;
  }

  void hold_velocities() {
    std::vector<DofBlock> moving = blocks_of(held_.bodies, slots_);
    rows_.update(held_.bodies, moving);
    double off = 0, fastest = 1;
    for (const DofBlock& b : moving) fastest = std::max({fastest, b.v.norm(), b.omega.norm()});
    for (size_t i = 0; i < rows_.size(); ++i)
      off = std::max(off, std::fabs(rows_.rate_off(i, moving)));
    if (off <= closed * fastest * size_) return;
    std::vector<double> impulses(rows_.size(), 0);
    rows_.hold_velocities(moving, impulses);
    for (size_t i = 0; i < moving.size(); ++i) {
      if (!held_.bodies[i].dynamic()) continue;
      held_.bodies[i].v = moving[i].v;
      held_.bodies[i].omega = moving[i].omega;
    }
  }

  /// After close_all() returned false: a fault for each joint that is open, or, if all are closed,
  /// one about the limits that are still violated.
  std::vector<std::pair<std::string, std::string>> faults() const;
  void tell(const World& world, std::vector<std::string>& out) const;
  void put(World& world) const;

 private:
  std::vector<std::pair<std::string, std::string>> open_joints() const;
  std::pair<std::string, std::string> passed_limits() const;

  void renew_rows() {
    const std::vector<uint32_t> joints = first_numbers(held_.joints.size());
    const std::vector<uint32_t> couplings = first_numbers(held_.couplings.size());
    rows_ = Articulation({held_.joints, held_.couplings}, {joints, couplings}, held_.block_of,
                         held_.bodies, held_.bodies.size(), Articulation::Drives::none);
  }

  /// Sum of the squared errors at the present poses.
  double square_error() {
    rows_.look(held_.bodies);
    double sum = 0;
    for (const JointRow& row : rows_.rows()) sum += row.error * row.error;
    return sum;
  }

  void move_from(const std::vector<RigidBody>& from, std::span<const DofBlock> way, double share) {
    for (size_t i = 0; i < from.size(); ++i) {
      if (!from[i].dynamic()) continue;
      held_.bodies[i].pose.x = from[i].pose.x + share * way[i].v;
      held_.bodies[i].pose.q = integrate_rotation(from[i].pose.q, share * way[i].omega, 1);
    }
  }

  /// The Newton step from the present poses, with limited length.
  std::vector<DofBlock> newton_step() {
    std::vector<DofBlock> way(held_.bodies.size());
    put_masses(held_.bodies, slots_, way);
    rows_.factor(way);
    std::vector<double> pushes(rows_.size(), 0);
    rows_.close(way, pushes);
    double turn = 0;
    for (const DofBlock& b : way) turn = std::max(turn, b.omega.norm());
    if (turn > longest_turn)
      for (DofBlock& b : way) b.v *= longest_turn / turn, b.omega *= longest_turn / turn;
    return way;
  }

  bool close_joints() {
    double now = square_error();
    for (int n = 0; n < most_steps && !stop_requested(); ++n) {
      if (rows_.error() <= closed_well * size_) return true;
      const std::vector<RigidBody> from = held_.bodies;
      const std::vector<DofBlock> way = newton_step();
      double share = 1, next = now;
      for (int k = 0; k < most_halvings; ++k, share *= 0.5) {
        move_from(from, way, share);
        next = square_error();
        if (next < now) break;
      }
      if (!(next < now)) {
        held_.bodies = from;
        square_error();
        break;
      }
      now = next;
    }
    return rows_.error() <= closed * size_;
  }

  /// A coordinate beyond a hard limit is fixed at the limit by a coupling x = 0 y + limit.
  bool add_passed_limits() {
    first_passed_ = held_.couplings.size();
    for (uint32_t j = 0; j < held_.joints.size(); ++j) {
      Joint joint = held_.joints[j];
      follow_coordinates(joint, held_.bodies, 0);
      for (uint32_t k = 0; k < entry_of(joint.kind).coordinates.size(); ++k) {
        const CoordinateLimits& l = (*joint.drives)[k].limits;
        const double x = joint.value[k], limit = x < l.lower ? l.lower : l.upper;
        const bool passed = x < l.lower - closed * size_ || x > l.upper + closed * size_;
        if (!l.hard() || !passed) continue;
        held_.couplings.push_back({j, j, k, k, 0, limit});
      }
    }
    return held_.couplings.size() > first_passed_;
  }

  JointedBodies held_;
  std::vector<uint32_t> slots_;
  std::vector<BodyStart> start_;
  double size_ = 1;  ///< [m]
  /// The couplings from this index on are limits added in the last round.
  size_t first_passed_ = 0;
  Articulation rows_;
};

std::vector<std::pair<std::string, std::string>> Assembly::open_joints() const {
  std::vector<std::pair<std::string, std::string>> out;
  size_t end = 0;
  for (size_t i = 0; i < rows_.size(); i = end) {
    const HeldRow& first = rows_.held()[i];
    double apart = 0, turned = 0;
    for (end = i; end < rows_.size() && rows_.held()[end].use == first.use &&
                  rows_.held()[end].owner == first.owner;
         ++end) {
      const JointRow& row = rows_.rows()[end];
      double& sum = row.row.a.linear.isZero(0) && row.row.b.linear.isZero(0) ? turned : apart;
      sum = std::hypot(sum, row.error);
    }
    if (std::max(apart, turned) <= closed * size_) continue;
    const bool couples = first.use == RowUse::coupling;
    const uint32_t joint = couples ? held_.couplings[first.owner].a : first.owner;
    std::string left;
    if (apart > closed * size_) left = fmt::format("{:.3g} m", apart);
    if (turned > closed * size_)
      left += fmt::format("{}{:.3g} rad", left.empty() ? "" : " and ", turned);
    out.emplace_back(
        "joints." + held_.names[joint],
        fmt::format("cannot be assembled: {} stay{} open by {}, however its bodies are "
                    "moved from where they are (place them nearer to where they fit, "
                    "or make lengths and limits that do)",
                    couples ? "its coupling or limit" : "its ends", couples ? "s" : "", left));
  }
  return out;
}

std::pair<std::string, std::string> Assembly::passed_limits() const {
  std::string names;
  for (size_t i = first_passed_; i < held_.couplings.size(); ++i)
    names += (names.empty() ? "" : ", ") + held_.names[held_.couplings[i].a];
  return {"joints",
          fmt::format("cannot be assembled: with the joints closed and limits kept {} times over, "
                      "limits of {} are still passed (place the bodies nearer to where they fit, "
                      "or make limits that do)",
                      most_limit_rounds, names)};
}

std::vector<std::pair<std::string, std::string>> Assembly::faults() const {
  auto out = open_joints();
  if (out.empty()) out.push_back(passed_limits());
  return out;
}

void Assembly::tell(const World& world, std::vector<std::string>& out) const {
  for (size_t i = 0; i < held_.bodies.size(); ++i) {
    const RigidBody& b = held_.bodies[i];
    const BodyStart& was = start_[i];
    const double numbers[] = {(b.pose.x - was.pose.x).norm(), was.pose.q.angularDistance(b.pose.q),
                              (b.v - was.v).norm(), (b.omega - was.omega).norm()};
    const char* words[] = {"moved by {:.4g} m", "turned by {:.4g} rad",
                           "velocity changed by {:.4g} m/s",
                           "angular velocity changed by {:.4g} rad/s"};
    std::string all;
    for (size_t k = 0; k < 4; ++k)
      if (numbers[k] > not_told)
        all += (all.empty() ? "" : ", ") + fmt::format(fmt::runtime(words[k]), numbers[k]);
    const auto def = world.body_def(held_.ids[i]);
    if (!all.empty() && def) out.push_back(fmt::format("assembled: bodies.{}: {}", def->name, all));
  }
}

void Assembly::put(World& world) const {
  for (size_t i = 0; i < held_.bodies.size(); ++i) {
    const RigidBody& b = held_.bodies[i];
    const BodyStart& was = start_[i];
    if (b.pose.x != was.pose.x || b.pose.q.coeffs() != was.pose.q.coeffs())
      (void)world.set_pose(held_.ids[i], b.body_frame());
    if (b.v != was.v || b.omega != was.omega) (void)world.set_velocity(held_.ids[i], b.v, b.omega);
  }
}

}  // namespace

std::vector<std::pair<std::string, std::string>> assemble(BuiltScene& built) {
  if (built.joints.empty()) return {};
  Assembly assembly(built);
  if (!assembly.close_all()) return assembly.faults();
  assembly.hold_velocities();
  assembly.tell(*built.world, built.assembly);
  assembly.put(*built.world);
  return {};
}

}  // namespace tumble
