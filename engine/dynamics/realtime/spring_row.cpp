#include "engine/dynamics/realtime/spring_row.hpp"

#include "engine/dynamics/realtime/solver_rows.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>

namespace tumble {
namespace {

Vec3 arm_now(const SolverContext& c, const SolverBody& body, const SolvedSpring::End& end) {
  if (end.slot == no_body) return Vec3::Zero();
  const Vec3 arm = c.bodies[end.slot].pose.direction(end.point);
  return arm + body.turn * arm;
}

Vec3 extent(const SolverContext& c, const SolverIsland& island, const SpringRow& row) {
  Vec3 q = row.start;
  for (uint32_t i = 0; i < row.count; ++i) q += row.weight[i] * island.bodies[row.body[i]].dx;
  if (row.turns == SpringRow::none) return q;
  for (uint32_t i = 0; i < row.count; ++i)
    q += row.weight[i] * arm_now(c, island.bodies[row.body[i]], c.springs[row.source].end[i]);
  return q;
}

/// Of q, with the present velocities.
Vec3 rate(const SolverIsland& island, const SpringRow& row) {
  Vec3 u = Vec3::Zero();
  for (uint32_t i = 0; i < row.count; ++i) u += row.weight[i] * island.bodies[row.body[i]].v;
  if (row.turns == SpringRow::none) return u;
  const SpringTurn& turn = island.spring_turns[row.turns];
  for (uint32_t i = 0; i < row.count; ++i)
    u += row.weight[i] * island.bodies[row.body[i]].w.cross(turn.arm[i]);
  return u;
}

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

/// What the sweeps use, from E = along n n^T + across (1 - n n^T) and the impulse along n that the
/// present length asks for.
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
  const Vec3 change = next - row.impulse;
  row.impulse = next;
  push(island, row, change);
  return change.dot(yielded);
}

}  // namespace

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
    }
    row.q = extent(c, island, row);
  }
}

void start_springs(const SolverContext& c, const SolverIsland& island, double hs) {
  for (SpringRow& row : island.springs) {
    row.impulse.setZero();
    const double length = row.q.norm(), k = row.stiffness;
    if (length > 0) row.n = row.q / length;
    // Without a length a spring that has one at rest has no direction to push in.
    const bool acts = length > 0 || row.rest_length == 0;
    const double slack = length > 0 ? row.rest_length / length : 0;
    const double aim = acts ? hs * k * (length - row.rest_length) : 0;
    const double along = acts ? hs * (hs * k + row.damping) : 0;
    const double across = acts ? hs * hs * k * std::max(0.0, 1 - slack) : 0;
    set_response(c, island, along, across, aim, row);
  }
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
