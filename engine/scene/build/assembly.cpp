#include "engine/scene/build/assembly.hpp"

#include "engine/core/stop.hpp"
#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"
#include "engine/scene/build/jointed_bodies.hpp"
#include "engine/scene/build/least_motion.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

struct BodyStart {
  Pose pose;
  Vec3 v, omega;
};

/// Axis times angle of a rotation, of at most half a turn [rad].
Vec3 rotation_vector(const Quat& q) {
  const double sine = q.vec().norm();
  if (!(sine > 0)) return Vec3::Zero();
  const double sign = q.w() < 0 ? -1 : 1;
  return sign * 2 * det::atan2(sine, sign * q.w()) / sine * q.vec();
}

/// The greatest displacement or turn of a body.
double length_of(std::span<const DofBlock> way) {
  double most = 0;
  for (const DofBlock& b : way) most = std::max({most, b.v.norm(), b.omega.norm()});
  return most;
}

/// No body turns farther than Newton's steps may.
void cut_turns(std::span<DofBlock> way) {
  double turn = 0;
  for (const DofBlock& b : way) turn = std::max(turn, b.omega.norm());
  if (turn > longest_turn)
    for (DofBlock& b : way) b.v *= longest_turn / turn, b.omega *= longest_turn / turn;
}

class Assembly {
 public:
  explicit Assembly(const BuiltScene& built) : held_(built), least_(held_) {
    for (const RigidBody& b : held_.bodies) {
      start_.push_back({b.pose, b.v, b.omega});
      size_ = std::max(size_, b.pose.x.norm());
    }
  }

  /// False: joints are left open, or limits passed.
  bool close_all() {
    if (!fit()) return false;
    settle();
    return true;
  }

  void hold_velocities() {
    const std::vector<DofBlock> before = blocks_of(held_.bodies, slots_);
    double fastest = 1;
    for (const DofBlock& b : before) fastest = std::max({fastest, b.v.norm(), b.omega.norm()});
    const double rounding = closed * fastest * size_;
    const std::vector<DofBlock> now = least_.velocity(before, rounding);
    std::vector<DofBlock> change = now;
    for (size_t i = 0; i < change.size(); ++i)
      change[i].v -= before[i].v, change[i].omega -= before[i].omega;
    if (length_of(change) <= rounding) return;
    for (size_t i = 0; i < now.size(); ++i) {
      if (!held_.bodies[i].dynamic()) continue;
      held_.bodies[i].v = now[i].v;
      held_.bodies[i].omega = now[i].omega;
    }
  }

  /// After close_all() gave false: a fault for each joint that is open or of which a limit is
  /// passed.
  std::vector<std::pair<std::string, std::string>> faults() const;
  void tell(const World& world, std::vector<std::string>& out) const;
  void put(World& world) const;

 private:
  void open_joints(std::vector<std::pair<std::string, std::string>>& out) const;
  void passed_limits(std::vector<std::pair<std::string, std::string>>& out) const;

  void move_from(const std::vector<RigidBody>& from, std::span<const DofBlock> way, double share) {
    for (size_t i = 0; i < from.size(); ++i) {
      if (!from[i].dynamic()) continue;
      held_.bodies[i].pose.x = from[i].pose.x + share * way[i].v;
      held_.bodies[i].pose.q = integrate_rotation(from[i].pose.q, share * way[i].omega, 1);
    }
    least_.look();
  }

  /// Newton's method, from where the bodies are: false if joints stay open or limits passed.
  bool fit() {
    least_.look();
    double now = least_.square_misfit();
    for (int n = 0; n < most_steps && !stop_requested(); ++n) {
      if (least_.misfit() <= closed_well * size_) return true;
      const std::vector<RigidBody> from = held_.bodies;
      std::vector<DofBlock> way =
          least_.displacement(std::vector<DofBlock>(from.size()), closed_well * size_);
      cut_turns(way);
      const double length = length_of(way);
      double next = now;
      for (double share = 1; share * length > closed_well * size_ && !(next < now); share *= 0.5) {
        move_from(from, way, share);
        next = least_.square_misfit();
      }
      if (!(next < now)) {
        held_.bodies = from;
        least_.look();
        break;
      }
      now = next;
    }
    return least_.misfit() <= closed * size_;
  }

  /// The way from where the bodies are back to where they stood.
  std::vector<DofBlock> way_back() const {
    std::vector<DofBlock> out(start_.size());
    for (size_t i = 0; i < out.size(); ++i) {
      const RigidBody& b = held_.bodies[i];
      if (!b.dynamic()) continue;
      out[i].v = start_[i].pose.x - b.pose.x;
      out[i].omega = rotation_vector(start_[i].pose.q * b.pose.q.conjugate());
    }
    return out;
  }

  /// From a state that fits to the nearest one to the start: each step is what of the way back the
  /// joints and limits allow, and is followed by Newton's method. Where no step shortens the way
  /// any more but by rounding, those that make the next one shorter still count.
  void settle() {
    double far = least_.square(way_back()), last = std::numeric_limits<double>::infinity();
    for (int n = 0; n < most_steps && far > 0 && !stop_requested(); ++n) {
      const std::vector<RigidBody> from = held_.bodies;
      std::vector<DofBlock> way = least_.displacement(way_back(), closed_well * size_);
      cut_turns(way);
      const double length = length_of(way);
      if (!(length < last) || length <= closed_well * size_) return;
      double share = 1, next = far;
      for (bool found = false; !found; share *= 0.5) {
        if (share * length <= closed_well * size_) {
          held_.bodies = from;
          least_.look();
          // The limits held here, by which velocities are projected, are not those of the trial.
          (void)least_.displacement(way_back(), closed_well * size_);
          return;
        }
        move_from(from, way, share);
        found = fit();
        next = least_.square(way_back());
        found = found && next <= far * (1 + closed_well);
      }
      last = next < far * (1 - closed_well) ? std::numeric_limits<double>::infinity() : length;
      far = next;
    }
  }

  JointedBodies held_;
  LeastMotion least_;
  std::vector<uint32_t> slots_ = first_numbers(held_.bodies.size());
  std::vector<BodyStart> start_;
  double size_ = 1;  ///< [m]
};

void Assembly::open_joints(std::vector<std::pair<std::string, std::string>>& out) const {
  const Articulation& rows = least_.equations();
  size_t end = 0;
  for (size_t i = 0; i < rows.size(); i = end) {
    const HeldRow& first = rows.held()[i];
    double apart = 0, turned = 0;
    for (end = i; end < rows.size() && rows.held()[end].use == first.use &&
                  rows.held()[end].owner == first.owner;
         ++end) {
      const JointRow& row = rows.rows()[end];
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
                    couples ? "its coupling" : "its ends", couples ? "s" : "", left));
  }
}

void Assembly::passed_limits(std::vector<std::pair<std::string, std::string>>& out) const {
  for (const KeptLimit& l : least_.limits()) {
    const double passed = least_.passed(l);
    if (passed <= closed * size_) continue;
    const JointCoordinate& c = entry_of(held_.joints[l.joint].kind).coordinates[l.coordinate];
    out.emplace_back(
        "joints." + held_.names[l.joint],
        fmt::format("cannot be assembled: its {} limit stays passed by {:.3g} {}, however its "
                    "bodies are moved from where they are (place them nearer to where they fit, "
                    "or make lengths and limits that do)",
                    l.sign > 0 ? "lower" : "upper", passed, c.angle ? "rad" : "m"));
  }
}

std::vector<std::pair<std::string, std::string>> Assembly::faults() const {
  std::vector<std::pair<std::string, std::string>> out;
  open_joints(out);
  passed_limits(out);
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
