#include "engine/dynamics/grains/solve_grains.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/grains/tolerances.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace tumble {
namespace {

/// The other side of a pair: a grain.
struct OtherGrain {
  GrainMover& m;
  double arm;

  Vec3 velocity(const Vec3& n) const { return m.v - arm * m.spin.cross(n); }
  Vec3 centre_velocity() const { return m.v; }
  const Vec3& spin() const { return m.spin; }
  void push(const Vec3& impulse, const Vec3& n) const {
    m.v += m.inverse_mass * impulse;
    m.spin -= (m.inverse_moment * arm) * n.cross(impulse);
  }
  void turn(const Vec3& torque) const { m.spin += m.inverse_moment * torque; }
};

/// The other side of a row with a body.
struct OtherBody {
  GrainBody& body;
  GrainBodyRow& row;

  Vec3 velocity(const Vec3&) const { return body.v + body.omega.cross(row.arm) + row.belt; }
  const Vec3& spin() const { return body.omega; }
  void push(const Vec3& impulse, const Vec3&) const {
    if (!body.gives_way) return;
    body.v += body.inverse_mass * impulse;
    body.omega += body.inverse_inertia * row.arm.cross(impulse);
  }
  void turn(const Vec3& torque) const {
    if (body.gives_way) body.omega += body.inverse_inertia * torque;
  }
};

/// A row between a grain and some other side.
template <class Other>
struct Solver {
  GrainRow& row;
  GrainMover& a;
  Other other;

  Vec3 slip() const { return other.velocity(row.n) - a.v - row.arm_a * a.spin.cross(row.n); }
  void push(const Vec3& impulse) const {
    other.push(impulse, row.n);
    a.v -= a.inverse_mass * impulse;
    a.spin -= (a.inverse_moment * row.arm_a) * row.n.cross(impulse);
  }
  void turn(const Vec3& torque) const {
    other.turn(torque);
    a.spin -= a.inverse_moment * torque;
  }

  /// The impulses of the sub-step before, turned into the present tangent plane.
  void warm_start() const {
    const Vec3& n = row.n;
    row.rub -= n.dot(row.rub) * n;
    const Vec3 u = slip(), w = other.spin() - a.spin;
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
    const Vec3 w = other.spin() - a.spin;
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
  /// Until the surfaces part with `speed` at least.
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
    // At most the gap may close.
    part_with(row.gap > 0 ? -row.gap * inverse_hs : row.lift * std::max(0.0, -row.gap - row.slop));
  }
  void bounce(double threshold) const {
    if (row.restitution == 0 || row.approach > -threshold || row.most == 0) return;
    part_with(-row.restitution * row.approach);
  }
};

class SweepGrains {
 public:
  SweepGrains(const GrainSystemRows& rows, double hs, Crew* crew)
      : r_(rows), hs_(hs), crew_(crew) {}

  void substep() {
    accelerate();
    sweep([](const auto& s) { s.warm_start(); });
    const double rate = 1 / hs_;
    sweep([rate](const auto& s) { s.sweep(rate); });
    move();
    time_ += hs_;
    part_overlapping();
    follow_all();
    sweep([rate](const auto& s) { s.sweep(rate); });
    for (const std::span<GrainBodyRow> rows : {r_.walls, r_.held})
      for_chunks(crew_, rows.size(), [&](size_t, size_t first, size_t last) {
        for (size_t k = first; k < last; ++k) count(rows[k]);
      });
  }
  void bounce() {
    for (const std::span<GrainBodyRow> rows : {r_.walls, r_.held})
      for (GrainBodyRow& row : rows) row.given += row.push * row.n;
    sweep([this](const auto& s) { s.bounce(r_.restitution_threshold); });
    for (const std::span<GrainBodyRow> rows : {r_.walls, r_.held})
      for (GrainBodyRow& row : rows) row.given -= row.push * row.n;
  }

 private:
  void accelerate() {
    for_chunks(crew_, r_.x.size(), [&](size_t, size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) r_.movers[i].v += hs_ * r_.acceleration[i];
    });
  }
  /// What touches nothing flies on an exact parabola.
  void move() {
    for_chunks(crew_, r_.x.size(), [&](size_t, size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) {
        Vec3 v = r_.movers[i].v;
        if (!r_.touched[i]) v -= (0.5 * hs_) * r_.acceleration[i];
        r_.x[i] += hs_ * v;
      }
    });
  }
  void follow(GrainRow& row) const {
    const Vec3 way = r_.x[row.b] - r_.x[row.a];
    const double distance = way.norm();
    if (distance > 0) row.n = way / distance;
    row.gap = distance - (r_.radius[row.a] + r_.radius[row.b]);
    row.arm_a = r_.radius[row.a] + 0.5 * row.gap;
    row.arm_b = r_.radius[row.b] + 0.5 * row.gap;
  }
  void follow(GrainBodyRow& row) const {
    row.gap = row.gap_from - row.n.dot(r_.x[row.a] - row.from) + row.drift * time_;
  }
  static void count(GrainBodyRow& row) {
    row.given -= row.push * row.n;
    row.rubbing -= row.rub;
    row.turning -= row.turn;
  }
  /// Moves grains apart that overlap, without giving them speed: sweeps that have not converged
  /// would turn such speed into bouncing.
  void part_overlapping() {
    for (size_t c = 0; c + 1 < r_.colour_first.size(); ++c) {
      const size_t begin = r_.colour_first[c], count = r_.colour_first[c + 1] - begin;
      for_chunks(crew_, count, [&](size_t, size_t first, size_t last) {
        for (size_t k = begin + first; k < begin + last; ++k) {
          GrainRow& row = r_.pairs[k];
          const Vec3 way = r_.x[row.b] - r_.x[row.a];
          const double reach = r_.radius[row.a] + r_.radius[row.b] - row.slop,
                       d2 = way.squaredNorm();
          if (d2 >= reach * reach || d2 == 0) continue;
          const double d = std::sqrt(d2);
          const Vec3 push = (tolerances::grain_push_out * row.normal_mass * (reach - d) / d) * way;
          r_.x[row.a] -= r_.movers[row.a].inverse_mass * push;
          r_.x[row.b] += r_.movers[row.b].inverse_mass * push;
        }
      });
    }
    for (const std::span<GrainBodyRow> rows : {r_.held, r_.walls})
      for (GrainBodyRow& row : rows) {
        follow(row);
        const double deep = -(row.gap + row.slop);
        if (deep > 0) r_.x[row.a] -= (tolerances::grain_push_out * deep) * row.n;
      }
  }
  /// What was a contact at one place is one at another now: impulses act where the grains are.
  void follow_all() {
    for_chunks(crew_, r_.pairs.size(), [&](size_t, size_t first, size_t last) {
      for (size_t k = first; k < last; ++k) follow(r_.pairs[k]);
    });
    for (const std::span<GrainBodyRow> rows : {r_.walls, r_.held})
      for (GrainBodyRow& row : rows) follow(row);
  }
  template <class F>
  void sweep(const F& f) {
    for (size_t c = 0; c + 1 < r_.colour_first.size(); ++c) {
      const size_t begin = r_.colour_first[c], count = r_.colour_first[c + 1] - begin;
      for_chunks(crew_, count, [&](size_t, size_t first, size_t last) {
        for (size_t k = begin + first; k < begin + last; ++k) {
          GrainRow& row = r_.pairs[k];
          f(Solver<OtherGrain>{row, r_.movers[row.a], {r_.movers[row.b], row.arm_b}});
        }
      });
    }
    for (GrainBodyRow& row : r_.held) with_body(row, f);
    for_chunks(crew_, r_.walls.size(), [&](size_t, size_t first, size_t last) {
      // Rows of one grain stay together.
      const auto start = [&](size_t k) {
        while (k > 0 && k < r_.walls.size() && r_.walls[k].a == r_.walls[k - 1].a) ++k;
        return k;
      };
      for (size_t k = start(first), end = start(last); k < end; ++k) with_body(r_.walls[k], f);
    });
  }
  template <class F>
  void with_body(GrainBodyRow& row, const F& f) {
    f(Solver<OtherBody>{row, r_.movers[row.a], {r_.bodies[row.b], row}});
  }

  const GrainSystemRows& r_;
  double hs_;
  Crew* crew_;
  double time_ = 0;  ///< since the beginning of the part [s]
};

}  // namespace

void solve_grains(const GrainSystemRows& rows, int substeps, double hs, Crew* crew) {
  SweepGrains sweeps(rows, hs, crew);
  for (int k = 0; k < substeps && !stop_requested(); ++k) sweeps.substep();
  sweeps.bounce();
}

void colour_pairs(std::span<const GrainRow> pairs, std::span<const GrainMover> movers,
                  std::vector<uint32_t>& order, std::vector<uint32_t>& first,
                  std::vector<uint32_t>& scratch, std::vector<uint64_t>& used) {
  constexpr uint32_t colours = 64;
  used.assign(movers.size(), 0);
  std::vector<uint32_t>& colour = order;  // until they are counted
  colour.resize(pairs.size());
  std::array<uint32_t, colours + 1> count{};
  for (size_t k = 0; k < pairs.size(); ++k) {
    const uint32_t a = pairs[k].a, b = pairs[k].b;
    const bool moves_a = movers[a].inverse_mass > 0, moves_b = movers[b].inverse_mass > 0;
    const uint64_t taken = (moves_a ? used[a] : 0) | (moves_b ? used[b] : 0);
    const auto c = uint32_t(std::countr_one(taken));
    colour[k] = c;
    ++count[c];
    if (c == colours) continue;
    if (moves_a) used[a] |= uint64_t{1} << c;
    if (moves_b) used[b] |= uint64_t{1} << c;
  }
  first.clear();
  std::array<uint32_t, colours + 1> next{};
  uint32_t sum = 0;
  for (uint32_t c = 0; c <= colours; ++c) {
    next[c] = sum;
    if (count[c] > 0 && c < colours) first.push_back(sum);
    sum += count[c];
  }
  for (uint32_t k = 0; k < count[colours]; ++k) first.push_back(next[colours] + k);
  first.push_back(sum);
  std::vector<uint32_t>& sorted = scratch;
  sorted.resize(pairs.size());
  for (uint32_t k = 0; k < pairs.size(); ++k) sorted[next[colour[k]]++] = k;
  order.swap(sorted);
}

}  // namespace tumble
