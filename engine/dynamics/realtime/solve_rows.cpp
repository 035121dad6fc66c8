// The inner loops of the realtime solver.
#include "engine/dynamics/realtime/solver_rows.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

namespace {

/// Velocities of the two bodies of a row, kept in registers while its points are solved.
struct Pair {
  Vec3 va, wa, vb, wb;
  const SolverBody& a;
  const SolverBody& b;

  Pair(const SolverBody& a_, const SolverBody& b_)
      : va(a_.v), wa(a_.w), vb(b_.v), wb(b_.w), a(a_), b(b_) {}
  void write(SolverBody& to_a, SolverBody& to_b) const {
    to_a.v = va;
    to_a.w = wa;
    to_b.v = vb;
    to_b.w = wb;
  }
  Vec3 slip(const PointRow& p) const { return vb + wb.cross(p.rb) - va - wa.cross(p.ra); }
  /// Applies an impulse P on B and -P on A.
  [[gnu::always_inline]] void push(const PointRow& p, const Vec3& P) {
    va -= a.inverse_mass * P;
    wa -= a.inverse_inertia * p.ra.cross(P);
    vb += b.inverse_mass * P;
    wb += b.inverse_inertia * p.rb.cross(P);
  }
  /// Applies an impulsive torque T on B and -T on A.
  void twist(const Vec3& T) {
    wa -= a.inverse_inertia * T;
    wb += b.inverse_inertia * T;
  }
};

void solve_friction(const ContactRow& row, PointRow& p, Pair& pair) {
  const Vec3 slip = pair.slip(p);
  const double s1 = row.t1.dot(slip) - row.target1;
  const double s2 = row.t2.dot(slip) - row.target2;
  const double limit = row.friction * p.normal;
  double f1 = p.tangent1 - (p.m11 * s1 + p.m12 * s2);
  double f2 = p.tangent2 - (p.m12 * s1 + p.m22 * s2);
  if (f1 * f1 + f2 * f2 > limit * limit) {
    // Sliding: a gradient step, whose fixed point opposes the slip in every direction alike.
    f1 = p.tangent1 - p.tangent_mass * s1;
    f2 = p.tangent2 - p.tangent_mass * s2;
    const double length2 = f1 * f1 + f2 * f2;
    if (length2 > limit * limit) {
      const double scale = limit / std::sqrt(length2);
      f1 *= scale;
      f2 *= scale;
    }
  }
  const Vec3 P = (f1 - p.tangent1) * row.t1 + (f2 - p.tangent2) * row.t2;
  p.tangent1 = f1;
  p.tangent2 = f2;
  pair.push(p, P);
}

/// From components about t1, t2, n to world axes.
Vec3 along_axes(const ContactRow& row, const Vec3& v) {
  return v.x() * row.t1 + v.y() * row.t2 + v.z() * row.n;
}

void solve_turning(const SolverIsland& island, ContactRow& row, Pair& pair) {
  double pressure = 0;
  for (uint32_t i = row.first; i < row.first + row.count; ++i) pressure += island.points[i].normal;
  const Vec3 w = pair.wb - pair.wa;
  const Vec3 turning(row.t1.dot(w), row.t2.dot(w), row.n.dot(w));
  pair.twist(along_axes(row, row.turning.solve(turning, pressure)));
}

void solve_all_friction(const SolverIsland& island, ContactRow& row, Pair& pair) {
  if (!(row.friction > 0)) return;
  for (uint32_t i = row.first; i < row.first + row.count; ++i) {
    solve_friction(row, island.points[i], pair);
  }
}

/// What the turning of round surfaces adds to the gap: it does not change as they turn, since only
/// the part of the arms inside the rounding turns.
double rolled_gap(const ContactRow& row, const Pair& pair) {
  return row.rounding_a * row.n.dot(pair.a.turn * row.n) +
         row.rounding_b * row.n.dot(pair.b.turn * row.n);
}

double gap_of(const ContactRow& row, const PointRow& p, const Pair& pair, double rolled) {
  const Vec3 moved = pair.b.dx + pair.b.turn * p.rb - pair.a.dx - pair.a.turn * p.ra;
  return p.gap + rolled + row.n.dot(moved);
}

void solve_normal(const ContactRow& row, PointRow& p, Pair& pair, double rolled, double hs,
                  double push_out_speed, bool with_bias) {
  const double gap = gap_of(row, p, pair, rolled);
  double bias = 0, mass_scale = 1, impulse_scale = 0;
  if (gap > 0) {
    bias = gap / hs;
  } else if (with_bias) {
    bias = std::max(row.soft.bias_rate * gap, -push_out_speed);
    mass_scale = row.soft.mass_scale;
    impulse_scale = row.soft.impulse_scale;
  }
  const double approach = row.n.dot(pair.slip(p));
  const double wanted =
      p.normal - p.normal_mass * mass_scale * (approach + bias) - impulse_scale * p.normal;
  const double next = std::max(wanted, 0.0);
  pair.push(p, (next - p.normal) * row.n);
  p.normal = next;
}

}  // namespace

double gap_of(const SolverIsland& island, const ContactRow& row, const PointRow& p) {
  const Pair pair(island.bodies[row.a], island.bodies[row.b]);
  return gap_of(row, p, pair, rolled_gap(row, pair));
}

void warm_start(const SolverIsland& island) {
  for (ContactRow& row : island.rows) {
    SolverBody& a = island.bodies[row.a];
    SolverBody& b = island.bodies[row.b];
    Pair pair(a, b);
    for (uint32_t i = row.first; i < row.first + row.count; ++i) {
      const PointRow& p = island.points[i];
      pair.push(p, p.normal * row.n + p.tangent1 * row.t1 + p.tangent2 * row.t2);
    }
    if (row.resists_turning) pair.twist(along_axes(row, row.turning.impulse));
    pair.write(a, b);
  }
}

namespace {

void solve_all_normals(const SolverIsland& island, const ContactRow& row, Pair& pair, double hs,
                       double push_out_speed, bool bias) {
  const double rolled = rolled_gap(row, pair);
  for (uint32_t i = row.first; i < row.first + row.count; ++i)
    solve_normal(row, island.points[i], pair, rolled, hs, push_out_speed, bias);
}

}  // namespace

void solve_normals(const SolverIsland& island, double hs, double push_out_speed) {
  for (const ContactRow& row : island.rows) {
    SolverBody& a = island.bodies[row.a];
    SolverBody& b = island.bodies[row.b];
    Pair pair(a, b);
    solve_all_normals(island, row, pair, hs, push_out_speed, false);
    pair.write(a, b);
  }
}

void solve_rows(const SolverIsland& island, double hs, double push_out_speed, bool bias) {
  for (ContactRow& row : island.rows) {
    SolverBody& a = island.bodies[row.a];
    SolverBody& b = island.bodies[row.b];
    Pair pair(a, b);
    // Friction first, so that normal impulses have the last word on overlap.
    solve_all_friction(island, row, pair);
    if (row.resists_turning && bias) solve_turning(island, row, pair);
    solve_all_normals(island, row, pair, hs, push_out_speed, bias);
    // Here torques are bounded by the normal impulses at the end of the sub-step. Those of the
    // sweep with bias are too small while a soft contact yields, and friction would be too small as
    // well.
    if (row.resists_turning && !bias) solve_turning(island, row, pair);
    pair.write(a, b);
  }
}

void solve_friction_again(const SolverIsland& island) {
  for (ContactRow& row : island.rows) {
    SolverBody& a = island.bodies[row.a];
    SolverBody& b = island.bodies[row.b];
    Pair pair(a, b);
    solve_all_friction(island, row, pair);
    pair.write(a, b);
  }
}

void sum_impulses(const SolverIsland& island) {
  for (ContactRow& row : island.rows) {
    if (row.resists_turning) row.turning.sum += row.turning.impulse;
  }
  for (PointRow& p : island.points) {
    p.normal_sum += p.normal;
    p.tangent1_sum += p.tangent1;
    p.tangent2_sum += p.tangent2;
  }
}

namespace {

/// Kinetic energy that a body lost since the start of the tick [J]; 0 for fixed and kinematic
/// bodies.
double lost_energy(const SolverContext& c, const SolverBody& body, const SolverMotion& motion) {
  if (!motion.dynamic) return 0;
  const RigidBody& source = c.bodies[motion.slot];
  const Vec3 w = (motion.dq * source.pose.q).conjugate() * body.w;
  return source.kinetic_energy() -
         0.5 * (source.mass * body.v.squaredNorm() + w.dot(source.inertia_body * w));
}

/// The greatest impulse that returns at most `energy` to bodies that separate at speed `v`.
double bounce_limit(double mass, double v, double energy) {
  return mass * (std::sqrt(v * v + 2 * std::max(energy, 0.0) / mass) - v);
}

}  // namespace

double apply_restitution(const SolverContext& c, const SolverIsland& island) {
  double most = 0;
  for (const ContactRow& row : island.rows) {
    SolverBody& a = island.bodies[row.a];
    SolverBody& b = island.bodies[row.b];
    for (uint32_t i = row.first; i < row.first + row.count; ++i) {
      PointRow& p = island.points[i];
      if (!(p.bounce > 0) || !(p.normal_sum > 0)) continue;
      Pair pair(a, b);
      const double apart = row.n.dot(pair.slip(p));
      double push = -p.normal_mass * (apart - p.bounce);
      // Springs return by themselves what they took of the energy of the approach.
      if (row.spins || !island.springs.empty())
        push = std::min(push, bounce_limit(p.normal_mass, apart,
                                           lost_energy(c, a, island.motions[row.a]) +
                                               lost_energy(c, b, island.motions[row.b])));
      // Impulses that joints made too large are reduced, but the contact never pulls.
      push = std::max(push, -p.rebound);
      if (push == 0) continue;
      pair.push(p, push * row.n);
      // The impulse of restitution counts in the sum, but not in the next warm start.
      p.normal_sum += push;
      p.rebound += push;
      pair.write(a, b);
      most = std::max(most, std::fabs(push) / (p.normal_mass * p.bounce));
    }
  }
  return most;
}

double store_rows(const SolverContext& c, const SolverIsland& island, double hs) {
  double residual = 0;
  for (const ContactRow& row : island.rows) {
    Contact& contact = c.contacts[row.source];
    const Pair pair(island.bodies[row.a], island.bodies[row.b]);
    if (row.resists_turning) {
      contact.turning_torque = along_axes(row, row.turning.impulse) / hs;
      contact.turning_impulse = along_axes(row, row.turning.sum);
    }
    for (uint32_t i = 0; i < row.count; ++i) {
      const PointRow& p = island.points[row.first + i];
      ContactPoint& out = contact.points[i];
      out.normal_force = p.normal / hs;
      out.friction_force = (p.tangent1 * row.t1 + p.tangent2 * row.t2) / hs;
      out.normal_impulse = p.normal_sum;
      out.friction_impulse = p.tangent1_sum * row.t1 + p.tangent2_sum * row.t2;
      if (p.normal > 0) residual = std::max(residual, -row.n.dot(pair.slip(p)));
    }
  }
  return residual;
}

}  // namespace tumble
