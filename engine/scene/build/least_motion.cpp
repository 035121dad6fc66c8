#include "engine/scene/build/least_motion.hpp"

#include "engine/core/stop.hpp"
#include "engine/dynamics/joints/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::vector<KeptLimit> hard_limits(const JointedBodies& bodies) {
  std::vector<KeptLimit> out;
  for (uint32_t j = 0; j < bodies.joints.size(); ++j)
    for (uint32_t k = 0; k < entry_of(bodies.joints[j].kind).coordinates.size(); ++k) {
      const CoordinateLimits& l = (*bodies.joints[j].drives)[k].limits;
      if (!l.hard()) continue;
      if (l.lower > -no_bound) out.push_back({j, k, l.lower, 1});
      if (l.upper < no_bound) out.push_back({j, k, l.upper, -1});
    }
  return out;
}

void add(std::span<const DofBlock> more, double factor, std::span<DofBlock> to) {
  for (size_t i = 0; i < to.size(); ++i) {
    to[i].v += factor * more[i].v;
    to[i].omega += factor * more[i].omega;
  }
}

}  // namespace

LeastMotion::LeastMotion(JointedBodies& bodies)
    : bodies_(bodies),
      slots_(first_numbers(bodies.bodies.size())),
      joints_(first_numbers(bodies.joints.size())),
      limits_(hard_limits(bodies)),
      rows_(limits_.size()),
      equations_({bodies.joints, bodies.couplings},
                 {joints_, first_numbers(bodies.couplings.size())}, bodies.block_of, bodies.bodies,
                 bodies.bodies.size(), Articulation::Drives::none) {}

void LeastMotion::look() {
  for (Joint& joint : bodies_.joints) follow_coordinates(joint, bodies_.bodies, 0);
  equations_.look(bodies_.bodies);
  for (size_t i = 0; i < limits_.size(); ++i) look_at(i);
}

/// The coordinate of a limit; the error of its row is x - bound.
void LeastMotion::look_at(size_t limit) {
  const KeptLimit& l = limits_[limit];
  const Joint& joint = bodies_.joints[l.joint];
  JointSides sides = sides_with_axes(joint, bodies_.bodies);
  const auto block = [this](uint32_t body) {
    return body == no_body ? no_block : bodies_.block_of[body];
  };
  sides.a.block = block(joint.a);
  sides.b.block = block(joint.b);
  rows_[limit] = entry_of(joint.kind).coordinates[l.coordinate].row(sides);
  rows_[limit].error = joint.value[l.coordinate] - l.bound;
}

double LeastMotion::passed(const KeptLimit& limit) const {
  return std::max(0.0, -limit.sign * rows_[size_t(&limit - limits_.data())].error);
}

double LeastMotion::square_misfit() const {
  double sum = 0;
  for (const JointRow& row : equations_.rows()) sum += row.error * row.error;
  for (const KeptLimit& l : limits_) sum += passed(l) * passed(l);
  return sum;
}

double LeastMotion::misfit() const {
  double most = equations_.error();
  for (const KeptLimit& l : limits_) most = std::max(most, passed(l));
  return most;
}

double LeastMotion::square(std::span<const DofBlock> motion) const {
  double sum = 0;
  for (size_t i = 0; i < motion.size(); ++i) {
    const RigidBody& b = bodies_.bodies[i];
    if (b.dynamic())
      sum += b.mass * motion[i].v.squaredNorm() +
             motion[i].omega.dot(b.inertia_world() * motion[i].omega);
  }
  return sum;
}

std::vector<DofBlock> LeastMotion::displacement(std::span<const DofBlock> wanted, double rounding) {
  sort_ = Sort::displacement;
  counted_ = first_numbers(limits_.size());
  return nearest(wanted, rounding);
}

std::vector<DofBlock> LeastMotion::velocity(std::span<const DofBlock> wanted, double rounding) {
  sort_ = Sort::velocity;
  counted_ = active_;
  return nearest(wanted, rounding);
}

double LeastMotion::slack(size_t limit, std::span<const DofBlock> motion) const {
  const double moved = row_velocity(rows_[limit].row, motion);
  return limits_[limit].sign * (moved + (sort_ == Sort::displacement ? rows_[limit].error : 0));
}

/// After the active set has changed. An active limit is a coordinate that follows nothing, at the
/// limit: x = 0 y + bound.
void LeastMotion::renew() {
  std::vector<JointCoupling> couplings = bodies_.couplings;
  for (const uint32_t i : active_) {
    const KeptLimit& l = limits_[i];
    couplings.push_back({l.joint, l.joint, l.coordinate, l.coordinate, 0, l.bound});
  }
  held_ = Articulation({bodies_.joints, couplings}, {joints_, first_numbers(couplings.size())},
                       bodies_.block_of, bodies_.bodies, bodies_.bodies.size(),
                       Articulation::Drives::none);
  std::vector<DofBlock> masses(slots_.size());
  put_masses(bodies_.bodies, slots_, masses);
  held_.update(bodies_.bodies, masses);
}

/// From the wanted motion to the nearest one that has the active limits as equations; their
/// multipliers are the pushes.
void LeastMotion::hold_active(std::span<DofBlock> motion) {
  std::vector<double> pushes(held_.size(), 0.0);
  if (sort_ == Sort::displacement)
    held_.close(motion, pushes);
  else
    held_.hold_velocities(motion, pushes);
  for (size_t k = 0; k < active_.size(); ++k)
    multipliers_[k] = std::max(0.0, limits_[active_[k]].sign * pushes[first_active_row() + k]);
}

/// Takes a limit into the active set, and changes the motion so that it is kept. False, with
/// nothing changed but the motion: no motion that the joints and the others allow keeps it.
bool LeastMotion::take(uint32_t limit, std::vector<DofBlock>& motion) {
  const std::vector<uint32_t> active_before = active_;
  const std::vector<double> multipliers_before = multipliers_;
  const double sign = limits_[limit].sign;
  double multiplier = 0;
  for (;;) {
    // What a push of the limit does to the motion, and to the multipliers of the others.
    std::vector<DofBlock> response(motion.size());
    put_masses(bodies_.bodies, slots_, response);
    apply_row(rows_[limit].row, sign, response);
    const double alone = sign * row_velocity(rows_[limit].row, response);
    std::vector<double> pushes(held_.size(), 0.0);
    held_.hold_displacements(response, pushes);
    const double gain = sign * row_velocity(rows_[limit].row, response);
    const bool locked = !(gain > tolerances::locked_share * alone);
    const double to_limit = locked ? infinite : std::max(0.0, -slack(limit, motion)) / gain;
    double to_release = infinite;
    size_t released = 0;
    for (size_t k = 0; k < active_.size(); ++k) {
      const double falls = -limits_[active_[k]].sign * pushes[first_active_row() + k];
      if (!(falls > 0) || !(multipliers_[k] / falls < to_release)) continue;
      to_release = multipliers_[k] / falls;
      released = k;
    }
    const double step = std::min(to_limit, to_release);
    if (step == infinite) {
      active_ = active_before;
      multipliers_ = multipliers_before;
      renew();
      return false;
    }
    if (!locked) add(response, step, motion);
    multiplier += step;
    for (size_t k = 0; k < active_.size(); ++k)
      multipliers_[k] += step * limits_[active_[k]].sign * pushes[first_active_row() + k];
    if (to_limit <= to_release) {
      active_.push_back(limit);
      multipliers_.push_back(multiplier);
      renew();
      return true;
    }
    active_.erase(active_.begin() + std::ptrdiff_t(released));
    multipliers_.erase(multipliers_.begin() + std::ptrdiff_t(released));
    renew();
  }
}

std::vector<DofBlock> LeastMotion::nearest(std::span<const DofBlock> wanted, double rounding) {
  active_.clear();
  multipliers_.clear();
  renew();
  const auto from_wanted = [&] {
    std::vector<DofBlock> motion(slots_.size());
    put_masses(bodies_.bodies, slots_, motion);
    add(wanted, 1, motion);
    hold_active(motion);
    return motion;
  };
  const auto off = [&](std::span<const DofBlock> motion) {
    std::vector<DofBlock> difference(motion.begin(), motion.end());
    add(wanted, -1, difference);
    return square(difference);
  };
  std::vector<DofBlock> motion = from_wanted();
  double farthest = off(motion);
  std::vector<bool> hopeless(limits_.size(), false);
  while (!stop_requested()) {
    const auto next = std::ranges::min_element(counted_, {}, [&](uint32_t i) {
      return hopeless[i] || std::ranges::count(active_, i) ? infinite : slack(i, motion);
    });
    if (next == counted_.end() || hopeless[*next] || !(slack(*next, motion) < -rounding)) break;
    if (!take(*next, motion)) hopeless[*next] = true;
    motion = from_wanted();
    if (hopeless[*next]) continue;
    // Only rounding could take the same limits in turn for ever.
    if (!(off(motion) > farthest)) break;
    farthest = off(motion);
  }
  return motion;
}

}  // namespace tumble
