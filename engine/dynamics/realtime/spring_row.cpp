#include "engine/dynamics/realtime/spring_row.hpp"

#include "engine/dynamics/realtime/solver_rows.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace tumble {
namespace {

/// Lever arm of an end at the present orientation; zero for an end in the world.
Vec3 arm_now(const SolverContext& c, const SolverBody& body, const SolvedSpring::End& end) {
  if (end.slot == no_body) return Vec3::Zero();
  const Vec3 arm = c.bodies[end.slot].pose.direction(end.point);
  return arm + body.turn * arm;
}

/// q at the present poses.
Vec3 extent(const SolverContext& c, const SolverIsland& island, const SpringRow& row) {
  Vec3 q = row.start;
  for (uint32_t i = 0; i < row.count; ++i) q += row.weight[i] * island.bodies[row.body[i]].dx;
  if (row.turns == SpringRow::none) return q;
  for (uint32_t i = 0; i < row.count; ++i)
    q += row.weight[i] * arm_now(c, island.bodies[row.body[i]], c.springs[row.source].end[i]);
  return q;
}

/// Rate of q with the present velocities.
Vec3 rate(const SolverIsland& island, const SpringRow& row) {
  Vec3 u = Vec3::Zero();
  for (uint32_t i = 0; i < row.count; ++i) u += row.weight[i] * island.bodies[row.body[i]].v;
  if (row.turns == SpringRow::none) return u;
  const SpringTurn& turn = island.spring_turns[row.turns];
  for (uint32_t i = 0; i < row.count; ++i)
    u += row.weight[i] * island.bodies[row.body[i]].w.cross(turn.arm[i]);
  return u;
}

/// Applies the impulse -w_i P to each end.
void push(const SolverIsland& island, const SpringRow& row, const Vec3& P) {
  for (uint32_t i = 0; i < row.count; ++i) {
    SolverBody& body = island.bodies[row.body[i]];
    body.v -= (row.weight[i] * body.inverse_mass) * P;
  }
  if (row.turns == SpringRow::none) return;
  const SpringTurn& turn = island.spring_turns[row.turns];
  for (uint32_t i = 0; i < row.count; ++i) {
    SolverBody& body = island.bodies[row.body[i]];
    body.w -= row.weight[i] * (body.inverse_inertia * turn.arm[i].cross(P));
  }
}

/// Sets what the sweeps use, from E = along n n^T + across (1 - n n^T) and the impulse `aim` along
/// n that the present length gives.
void set_response(const SolverContext& c, const SolverIsland& island, double along, double across,
                  double aim, SpringRow& row) {
  row.mobility = 0;
  for (uint32_t i = 0; i < row.count; ++i)
    row.mobility += row.weight[i] * row.weight[i] * island.bodies[row.body[i]].inverse_mass;
  if (row.turns == SpringRow::none) {
    const double share = 1 / (1 + along * row.mobility);
    row.along = share * along;
    row.across = across / (1 + across * row.mobility);
    row.aim = (share * aim) * row.n;
    return;
  }
  SpringTurn& turn = island.spring_turns[row.turns];
  turn.yields = row.mobility * Mat3::Identity();
  for (uint32_t i = 0; i < row.count; ++i) {
    const SolverBody& body = island.bodies[row.body[i]];
    turn.arm[i] = arm_now(c, body, c.springs[row.source].end[i]);
    const Mat3 r = skew(turn.arm[i]);
    turn.yields += (row.weight[i] * row.weight[i]) * (r * body.inverse_inertia * r.transpose());
  }
  const Mat3 nn = row.n * row.n.transpose();
  const Mat3 E = along * nn + across * (Mat3::Identity() - nn);
  const Mat3 share = (Mat3::Identity() + E * turn.yields).inverse();
  turn.follows = share * E;
  row.aim = aim * (share * row.n);
}

double solve_spring(const SolverIsland& island, SpringRow& row) {
  const Vec3 u = rate(island, row);
  Vec3 next = row.aim, yielded;
  if (row.turns == SpringRow::none) {
    const Vec3 free = u + row.mobility * row.impulse;
    next += row.across * free + ((row.along - row.across) * row.n.dot(free)) * row.n;
    yielded = row.mobility * (next - row.impulse);
  } else {
    const SpringTurn& turn = island.spring_turns[row.turns];
    next += turn.follows * (u + turn.yields * row.impulse);
    yielded = turn.yields * (next - row.impulse);
  }
  row.change = next - row.impulse;
  row.impulse = next;
  push(island, row, row.change);
  return row.change.dot(yielded);
}

}  // namespace

SpringMotion spring_motion(const SolvedSpring& spring, std::span<const RigidBody> bodies) {
  SpringMotion motion;
  for (uint32_t i = 0; i < spring.count; ++i) {
    const SolvedSpring::End& end = spring.end[i];
    if (end.slot == no_body) {
      motion.q += end.weight * end.point;
      continue;
    }
    const RigidBody& body = bodies[end.slot];
    const Vec3 arm = body.pose.direction(end.point);
    motion.q += end.weight * (body.pose.x + arm);
    motion.rate += end.weight * (body.v + body.omega.cross(arm));
    motion.mobility += end.weight * end.weight * body.inverse_mass;
  }
  return motion;
}

void prepare_springs(const SolverContext& c, const SolverIsland& island) {
  for (SpringRow& row : island.springs) {
    const SolvedSpring& spring = c.springs[row.source];
    row.stiffness = spring.stiffness;
    row.damping = spring.damping;
    row.rest_length = spring.rest_length;
    row.start = row.sum = row.elastic = Vec3::Zero();
    for (uint32_t i = 0; i < row.count; ++i) {
      const SolvedSpring::End& end = spring.end[i];
      row.start += end.weight * (end.slot == no_body ? end.point : c.bodies[end.slot].pose.x);
      // Fixed for a body that does not turn.
      if (end.slot != no_body && row.turns == SpringRow::none)
        row.start += end.weight * c.bodies[end.slot].pose.direction(end.point);
    }
    row.q = extent(c, island, row);
  }
}

namespace {

/// Transverse stiffness of a stretched spring [N/m].
double stiffness_across(const SpringRow& row, double length) {
  return length > row.rest_length ? row.stiffness * (1 - row.rest_length / length) : 0;
}

/// By solver body: sum of transverse stiffness over mass of its springs [1/s2].
std::span<const double> swings_across(const SolverIsland& island) {
  thread_local std::vector<double> sums;
  sums.assign(island.bodies.size(), 0);
  for (const SpringRow& row : island.springs) {
    const double k = stiffness_across(row, row.q.norm());
    for (uint32_t i = 0; i < row.count; ++i)
      sums[row.body[i]] +=
          row.weight[i] * row.weight[i] * k * island.bodies[row.body[i]].inverse_mass;
  }
  return sums;
}

/// Applies the share of the guessed impulses P that is nearest to the solution. Springs alone
/// minimise P A P / 2 - P u + |P|^2 / 2e - P a / e, where A P is the change of the rates u, a the
/// impulses that lengths give and e those per rate; `gains` and `costs` are the sums of P a / e and
/// |P|^2 / e. So the start is never worse than none, however much the springs have moved since.
void start_from_guess(const SolverIsland& island, double gains, double costs) {
  for (const SpringRow& row : island.springs) {
    const double along = row.impulse.dot(rate(island, row));
    gains += along;
    costs += along;
  }
  for (const SpringRow& row : island.springs) push(island, row, row.impulse);
  for (const SpringRow& row : island.springs) costs -= row.impulse.dot(rate(island, row));
  const double share = costs > 0 ? std::clamp(gains / costs, 0.0, 1.0) : 0;
  for (SpringRow& row : island.springs) {
    push(island, row, (share - 1) * row.impulse);
    row.impulse *= share;
  }
}

}  // namespace

void start_springs(const SolverContext& c, const SolverIsland& island, double hs, bool first) {
  const std::span<const double> swings = swings_across(island);
  double gains = 0, costs = 0;
  for (SpringRow& row : island.springs) {
    const double length = row.q.norm(), k = row.stiffness;
    if (length > 0) row.n = row.q / length;
    // A spring of zero length that has a rest length has no direction of force.
    const bool acts = length > 0 || row.rest_length == 0;
    const double aim = acts ? hs * k * (length - row.rest_length) : 0;
    const double along = acts ? hs * (hs * k + row.damping) : 0;
    const double guess = along == 0 ? 0 : first ? aim : row.n.dot(row.impulse);
    row.impulse = guess * row.n;
    if (guess != 0) {
      gains += guess * aim / along;
      costs += guess * guess / along;
    }
    double across = stiffness_across(row, length);
    if (row.rest_length > 0) {
      double z = 0;
      for (uint32_t i = 0; i < row.count; ++i) z += hs * hs * swings[row.body[i]];
      across *= std::max(0.0, 1 - 1 / z);
    } else {
      across = k;  // the same in all directions
    }
    set_response(c, island, along, hs * hs * across, aim, row);
  }
  start_from_guess(island, gains, costs);
}

double sweep_springs(const SolverIsland& island, bool back) {
  double change = 0;
  if (back)
    for (size_t k = island.springs.size(); k-- > 0;)
      change += solve_spring(island, island.springs[k]);
  else
    for (SpringRow& row : island.springs) change += solve_spring(island, row);
  return change;
}

void accelerate_springs(const SolverIsland& island, double share) {
  const bool anew = !(share < 1);
  for (SpringRow& row : island.springs) {
    if (anew) {
      row.step.setZero();
      continue;
    }
    row.step *= share;
    row.impulse += row.step;
    push(island, row, row.step);
    row.step += row.change;
  }
}

void sum_springs(const SolverContext& c, const SolverIsland& island, double hs) {
  for (SpringRow& row : island.springs) {
    row.sum += row.impulse;
    row.q = extent(c, island, row);
    const double length = row.q.norm();
    const double slack = length > 0 ? row.rest_length / length : 0;
    row.elastic += (hs * row.stiffness * (1 - slack)) * row.q;
    if (row.turns == SpringRow::none) continue;
    SolvedSpring& spring = c.springs[row.source];
    for (uint32_t i = 0; i < row.count; ++i)
      spring.end[i].moment -=
          row.weight[i] * island.spring_turns[row.turns].arm[i].cross(row.impulse);
  }
}

void store_springs(const SolverContext& c, const SolverIsland& island) {
  for (const SpringRow& row : island.springs) {
    c.springs[row.source].impulse = row.sum;
    c.springs[row.source].elastic = row.elastic;
  }
}

}  // namespace tumble
