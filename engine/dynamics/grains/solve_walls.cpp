#include "engine/dynamics/grains/solve_walls.hpp"

#include "engine/core/prefetch.hpp"
#include "engine/dynamics/grains/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// The grain of a row, in double precision; written back at the end.
struct WallGrain {
  GrainRow& to;
  Vec3 v, spin;
  double inverse_mass, inverse_moment;

  WallGrain(GrainRow& row, const GrainMover& mover)
      : to(row),
        v(double(row.v[0]), double(row.v[1]), double(row.v[2])),
        spin(double(row.spin[0]), double(row.spin[1]), double(row.spin[2])),
        inverse_mass(mover.inverse_mass),
        inverse_moment(mover.inverse_moment) {}
  WallGrain(const WallGrain&) = delete;
  WallGrain& operator=(const WallGrain&) = delete;
  ~WallGrain() {
    for (int axis = 0; axis < 3; ++axis) {
      to.v[size_t(axis)] = float(v[axis]);
      to.spin[size_t(axis)] = float(spin[axis]);
    }
  }
};

/// One row with its grain and body.
struct WallSolver {
  GrainBodyRow& row;
  WallGrain& a;
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
  /// Returns the normal velocity after it [m/s].
  double resist_slip() const {
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
    // Friction on a grain alone acts across the normal.
    return row.n.dot(b.gives_way ? slip() : u);
  }
  /// Applies a normal impulse so that the surfaces, whose normal velocity is `u`, separate at no
  /// less than `speed`.
  void part_with(double speed, double u) const {
    const double next = std::max(0.0, row.push - row.normal_mass * (u - speed));
    const double change = next - row.push;
    row.push = next;
    row.most = std::max(row.most, next);
    row.lost += change * (u + 0.5 * change / row.normal_mass);
    push(change * row.n);
  }
  void sweep(double inverse_hs) const {
    if (row.turn_mass > 0) resist_turning();
    const double u = resist_slip();
    // The gap may at most close.
    part_with(row.gap > 0 ? -row.gap * inverse_hs : row.lift * std::max(0.0, -row.gap - row.slop),
              u);
  }
};

/// How many rows ahead the grain of a row is fetched: some hundred nanoseconds.
constexpr size_t rows_ahead = 2;

/// Calls f(solver) for each row.
template <class F>
void each_row(const GrainWalls& in, std::span<GrainBodyRow> rows, const F& f) {
  for (size_t k = 0; k < rows.size(); ++k) {
    GrainBodyRow& row = rows[k];
    const uint32_t later = rows[std::min(k + rows_ahead, rows.size() - 1)].a;
    prefetch(&in.rows[later]);
    prefetch(&in.movers[later]);
    WallGrain grain(in.rows[row.a], in.movers[row.a]);
    f(WallSolver{row, grain, in.bodies[row.b]});
  }
}

void follow(const GrainShift& shift, GrainBodyRow& row, double time) {
  const Vec3 moved(double(shift.x[0]), double(shift.x[1]), double(shift.x[2]));
  row.gap = row.gap_from - row.n.dot(moved) + row.drift * time;
}

/// Moves the grain out of overlap.
void part_overlapping(GrainShift& shift, const GrainBodyRow& row) {
  const double deep = -(row.gap + row.slop);
  if (!(deep > 0)) return;
  for (int axis = 0; axis < 3; ++axis)
    shift.x[size_t(axis)] -= float(tolerances::grain_push_out * deep * row.n[axis]);
}

}  // namespace

void warm_start(const GrainWalls& in, std::span<GrainBodyRow> rows) {
  each_row(in, rows, [](const WallSolver& s) { s.warm_start(); });
}

void sweep(const GrainWalls& in, std::span<GrainBodyRow> rows, double inverse_hs) {
  each_row(in, rows, [inverse_hs](const WallSolver& s) { s.sweep(inverse_hs); });
}

void part_overlapping(const GrainWalls& in, std::span<GrainBodyRow> rows, double time) {
  for (GrainBodyRow& row : rows) {
    follow(in.shifts[row.a], row, time);
    part_overlapping(in.shifts[row.a], row);
  }
}

void follow(const GrainWalls& in, std::span<GrainBodyRow> rows, double time, double inverse_hs) {
  each_row(in, rows, [&](const WallSolver& s) {
    GrainBodyRow& row = s.row;
    follow(in.shifts[row.a], row, time);
    s.sweep(inverse_hs);
    row.given -= row.push * row.n;
    row.rubbing -= row.rub;
    row.turning -= row.turn;
  });
}

void bounce(const GrainWalls& in, std::span<GrainBodyRow> rows, double threshold) {
  each_row(in, rows, [threshold](const WallSolver& s) {
    GrainBodyRow& row = s.row;
    if (row.restitution == 0 || row.approach > -threshold || row.most == 0) return;
    row.given += row.push * row.n;
    s.part_with(-row.restitution * row.approach, row.n.dot(s.slip()));
    row.given -= row.push * row.n;
  });
}

}  // namespace tumble
