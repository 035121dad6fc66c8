#include "engine/dynamics/grains/solve_walls.hpp"

#include "engine/dynamics/grains/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// One row with its grain and body.
struct WallSolver {
  GrainBodyRow& row;
  GrainMover& a;
  GrainBody& b;

  Vec3 slip() const {
    return b.v + b.omega.cross(row.arm) + row.belt - a.v - row.arm_a * a.spin.cross(row.n);
  }
  void push(const Vec3& impulse) const {
    if (b.gives_way) {
      b.v += b.inverse_mass * impulse;
      b.omega += b.inverse_inertia * row.arm.cross(impulse);
    }
    a.v -= a.inverse_mass * impulse;
    a.spin -= (a.inverse_moment * row.arm_a) * row.n.cross(impulse);
  }
  void turn(const Vec3& torque) const {
    if (b.gives_way) b.omega += b.inverse_inertia * torque;
    a.spin -= a.inverse_moment * torque;
  }
  void warm_start() const {
    const Vec3& n = row.n;
    row.rub -= n.dot(row.rub) * n;
    const Vec3 u = slip(), w = b.omega - a.spin;
    const double un = n.dot(u);
    row.lost += row.push * (un + 0.5 * row.push / row.normal_mass);
    row.rubbed += row.rub.dot(u) + 0.5 * row.rub.squaredNorm() / row.slip_mass;
    push(row.push * n + row.rub);
    if (row.turn_mass > 0) {
      row.rubbed += row.turn.dot(w) + 0.5 * row.turn.squaredNorm() / row.turn_mass;
      turn(row.turn);
    }
    row.most = std::max(row.most, row.push);
  }
  void resist_turning() const {
    const Vec3& n = row.n;
    const Vec3 w = b.omega - a.spin;
    const Vec3 wanted = row.turn - row.turn_mass * w;
    const double about =
        std::clamp(n.dot(wanted), -row.twisting * row.push, row.twisting * row.push);
    Vec3 rolling = wanted - n.dot(wanted) * n;
    const double size2 = rolling.squaredNorm(), most = row.rolling * row.push;
    if (size2 > most * most) rolling *= most / std::sqrt(size2);
    const Vec3 next = about * n + rolling, change = next - row.turn;
    row.turn = next;
    row.rubbed += change.dot(w) + 0.5 * change.squaredNorm() / row.turn_mass;
    turn(change);
  }
  void resist_slip() const {
    const Vec3 u = slip();
    const Vec3 across = u - row.n.dot(u) * row.n;
    Vec3 next = row.rub - row.slip_mass * across;
    next -= row.n.dot(next) * row.n;
    const double size2 = next.squaredNorm(), most = row.friction * row.push;
    if (size2 > most * most) next *= most / std::sqrt(size2);
    const Vec3 change = next - row.rub;
    row.rub = next;
    row.rubbed += change.dot(across) + 0.5 * change.squaredNorm() / row.slip_mass;
    push(change);
  }
  /// Applies a normal impulse so that the surfaces separate at no less than `speed`.
  void part_with(double speed) const {
    const double u = row.n.dot(slip());
    const double next = std::max(0.0, row.push - row.normal_mass * (u - speed));
    const double change = next - row.push;
    row.push = next;
    row.most = std::max(row.most, next);
    row.lost += change * (u + 0.5 * change / row.normal_mass);
    push(change * row.n);
  }
  void sweep(double inverse_hs) const {
    if (row.turn_mass > 0) resist_turning();
    resist_slip();
    // The gap may at most close.
    part_with(row.gap > 0 ? -row.gap * inverse_hs : row.lift * std::max(0.0, -row.gap - row.slop));
  }
};

WallSolver solver(const GrainWalls& in, GrainBodyRow& row) {
  return {row, in.movers[row.a], in.bodies[row.b]};
}

void follow(const GrainWalls& in, GrainBodyRow& row, double time) {
  row.gap = row.gap_from - row.n.dot(in.points[row.a].x - row.from) + row.drift * time;
}

}  // namespace

void warm_start(const GrainWalls& in, std::span<GrainBodyRow> rows) {
  for (GrainBodyRow& row : rows) solver(in, row).warm_start();
}

void sweep(const GrainWalls& in, std::span<GrainBodyRow> rows, double inverse_hs) {
  for (GrainBodyRow& row : rows) solver(in, row).sweep(inverse_hs);
}

void part_overlapping(const GrainWalls& in, std::span<GrainBodyRow> rows, double time) {
  for (GrainBodyRow& row : rows) {
    follow(in, row, time);
    const double deep = -(row.gap + row.slop);
    if (deep > 0) in.points[row.a].x -= (tolerances::grain_push_out * deep) * row.n;
  }
}

void follow(const GrainWalls& in, std::span<GrainBodyRow> rows, double time) {
  for (GrainBodyRow& row : rows) follow(in, row, time);
}

void count_impulses(std::span<GrainBodyRow> rows) {
  for (GrainBodyRow& row : rows) {
    row.given -= row.push * row.n;
    row.rubbing -= row.rub;
    row.turning -= row.turn;
  }
}

void bounce(const GrainWalls& in, std::span<GrainBodyRow> rows, double threshold) {
  for (GrainBodyRow& row : rows) {
    if (row.restitution == 0 || row.approach > -threshold || row.most == 0) continue;
    row.given += row.push * row.n;
    solver(in, row).part_with(-row.restitution * row.approach);
    row.given -= row.push * row.n;
  }
}

}  // namespace tumble
