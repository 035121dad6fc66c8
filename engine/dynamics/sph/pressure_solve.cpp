// Pressures p >= 0 of the particles of an incompressible fluid. With D the operator that makes
// rates of shares of velocities (PressureForces::open), V D^T p are the forces of pressures,
// so that D M^-1 D^T is symmetric, with the bodies' masses in M: the velocities that they leave are
// the nearest to those before that are allowed, and have no more energy.
//
// D is the divergence with the slopes of kernels corrected so that it is exact for velocities that
// are linear in places (Bonet and Lok, "Variational and momentum preservation aspects of smooth
// particle hydrodynamic formulations", 1999): no shear, which is one, has a rate, and so D^T p is
// an isotropic stress, however particles lie. Of plain slopes the shear of a lattice has rates, and
// a fluid at rest a yield stress.
//
// Beside walls the corrected forces are S V D^T p: along the normal a wall bears a part of the
// particle's layer (WallTouch::lever), as if the particle had so much less mass there. D S M^-1 D^T
// is still symmetric, and energy in those masses does not grow.
//
// What of the density is wrong by then, since rates are not differences, moves particles and no
// velocities (Cornelis et al., "An optimized source term formulation for incompressible SPH",
// 2019): else it would stir the fluid for ever.
#include "engine/core/stop.hpp"
#include "engine/dynamics/sph/fluid_state.hpp"

#include <cmath>

namespace tumble {
namespace {

/// Of which operator D pressures are: that of shares themselves, or the corrected one of
/// find_corrections.
enum class Sums : uint8_t { of_shares, corrected };

SingleVector single(const Vec3& v, double w) {
  return {float(v[0]), float(v[1]), float(v[2]), float(w)};
}
Vec3 vector(const SingleVector& v) {
  return {double(v.x), double(v.y), double(v.z)};
}

/// Where particles are, and what of the iterations' gradients depends on that alone.
void place_rows(FluidState& s) {
  PressureOperands& to = s.pressure_operands;
  const size_t n = s.size(), places = s.lists.places();
  to.rows.resize(places), to.pushes.resize(places), to.volumes.resize(n);
  to.plain_gradients.resize(n);
  to.rows.back() = {}, to.pushes.back() = {};
  const double per_reach = 1 / s.kernel.reach();
  s.each([&](size_t p) {
    const FluidPlace at = FluidPlace::of(per_reach * s.x(p));
    to.volumes[p] = float(s.kernel.scale() * s.volume[p]);
    to.rows[p].at = at;
    to.pushes[p] = {at, to.volumes[p], 0};
  });
  s.each_batch<SingleVector>(
      [&](size_t first, size_t end, SingleVector* sums) {
        push_groups(s.pairs, first, end, to.pushes.data(), sums);
      },
      [&](size_t, size_t p, const SingleVector& sum) { to.plain_gradients[p] = sum; });
}

/// Forces of pressures, and what bodies make of them. While pressures are sought they are in single
/// precision, of rounded slopes; what acts in the end is in double, pair by pair equal and
/// opposite.
class PressureForces {
 public:
  PressureForces(FluidState& s, Sums sums, bool bodies_yield)
      : s_(s),
        to_(s.pressure_operands),
        corrected_(sums == Sums::corrected),
        responses_(s.bodies.size()) {
    if (!bodies_yield) return;
    for (const FluidBody& b : s.body_defs) bodies_yield_ = bodies_yield_ || b.inverse_mass > 0;
  }

  /// What all the others need, but press_by_state.
  void take_operands() {
    FluidState& s = s_;
    to_.gradients.resize(s.size()), to_.weights.resize(s.size());
    if (corrected_) to_.corrections.resize(s.size()), to_.stresses.resize(s.lists.places());
    if (corrected_) to_.stresses.back() = {};
    const double length = s.kernel.reach();
    s.each([&](size_t p) {
      const double volume = double(to_.volumes[p]);
      Vec3 sum = vector(to_.plain_gradients[p]);
      if (corrected_) {
        sum = s.correction[p] * sum;
        to_.corrections[p] = SymmetricRow<float>::of(s.correction[p]);
        to_.stresses[p].at = to_.rows[p].at;
      }
      for (const WallTouch& t : s.touches_of(p)) sum += length * gradient(t);
      to_.gradients[p] = single(1 / volume * sum, volume / (length * s.density[p]));
    });
  }

  /// From now on flows are those of the velocities, too, as if they were accelerations that last
  /// for the sub-step; adds to `source` what walls that move make of it [1/s2]: fluid behind a wall
  /// moves as the mirror image.
  void take_velocities(std::vector<double>& source) {
    FluidState& s = s_;
    to_.moving.resize(s.size());
    s.each([&](size_t p) {
      to_.moving[p] = single(double(to_.volumes[p]) / s.h * s.v[p], 0);
      for (const WallTouch& t : s.touches_of(p))
        source[p] -= s.bodies[t.body].velocity_at(s.x(p)).dot(gradient(t)) / s.h;
    });
  }

  /// The particle at place p is to push others by its weight.
  void press(size_t p) {
    if (corrected_)
      to_.stresses[p].set(to_.corrections[p].times(to_.weights[p]));
    else
      to_.pushes[p].weight = to_.weights[p];
  }
  /// Flows, and what bodies do, by the velocities and by pressures pressure(p).
  template <class F>
  void find(const F& pressure) {
    s_.each_batch<SingleVector>(
        [&](size_t first, size_t end, SingleVector* sums) {
          if (corrected_)
            push_groups(s_.pairs, first, end, to_.stresses.data(), sums);
          else
            push_groups(s_.pairs, first, end, to_.pushes.data(), sums);
        },
        [&](size_t, size_t p, const SingleVector& sum) {
          const SingleVector& g = to_.gradients[p];
          const float w = to_.weights[p];
          SingleVector& flow = to_.rows[p].flow;
          flow = {-g.w * (sum.x + w * g.x), -g.w * (sum.y + w * g.y), -g.w * (sum.z + w * g.z), 0};
          if (corrected_ && touched(p)) lever(p, flow);
          const SingleVector& u = to_.moving[p];
          flow.x += u.x, flow.y += u.y, flow.z += u.z;
        });
    if (!bodies_yield_) return;
    const std::vector<Wrench> forces = on_bodies(pressure);
    for (size_t b = 0; b < forces.size(); ++b) responses_[b] = s_.response(b, forces[b]);
  }
  /// f(chunk, p, rate of change of the particle's rate by the flows [1/s2]).
  template <class F>
  void open(const F& f) {
    const auto per_unit = float(1 / s_.kernel.reach());
    s_.each_batch<float>(
        [&](size_t first, size_t end, float* sums) {
          open_groups(s_.pairs, first, end, to_.rows.data(),
                      corrected_ ? to_.corrections.data() : nullptr, sums);
        },
        [&](size_t chunk, size_t p, float sum) {
          const SingleVector &u = to_.rows[p].flow, &g = to_.gradients[p];
          const float found = per_unit * (((u.x * g.x + u.y * g.y) + u.z * g.z) - sum);
          f(chunk, p, double(found) + opened_by_bodies(p));
        });
  }
  /// By pressures [m/s2].
  Vec3 acceleration(size_t p) const {
    return 1 / double(to_.volumes[p]) * (vector(to_.rows[p].flow) - vector(to_.moving[p]));
  }
  double diagonal(size_t p) const { return corrected_ ? s_.corrected_diagonal[p] : s_.diagonal[p]; }

  /// Accelerations of the fluid, in double.
  void find_exactly(const std::vector<double>& pressure) {
    if (corrected_)
      find_corrected(pressure);
    else
      find_plain(pressure);
  }
  /// Accelerations that were found have acted for the sub-step.
  void act(const std::vector<double>& pressure) {
    s_.report.pressure_work += s_.accelerate();
    std::vector<Wrench> forces = on_bodies([&](size_t p) { return pressure[p]; });
    for (Wrench& w : forces) w.impulse *= s_.h, w.angular_impulse *= s_.h;
    s_.push_bodies(forces);
  }

 private:
  void find_corrected(const std::vector<double>& pressure) {
    FluidState& s = s_;
    to_.exact_stresses.resize(s.lists.places());
    to_.exact_stresses.back() = {};
    s.each([&](size_t p) {
      to_.exact_stresses[p] =
          SymmetricRow<double>::of(s.correction[p]).times(s.volume[p] * pressure[p]);
    });
    s.each_batch<FluidVector>(
        [&](size_t first, size_t end, FluidVector* sums) {
          push_exactly(s.pairs, first, end, s.at.data(), to_.exact_stresses.data(), sums);
        },
        [&](size_t, size_t p, const FluidVector& sum) {
          Vec3 force = pressure[p] * (s.correction[p] * s.fluid_gradient[p]) + sum.vector();
          for (const WallTouch& t : s.touches_of(p)) force += pressure[p] * t.corrected;
          const Vec3 plain = -(1 / s.density[p]) * force;
          s.acceleration.set(p, touched(p) ? Vec3(plain + levered(p, plain)) : plain);
        });
  }
  void find_plain(const std::vector<double>& pressure) {
    FluidState& s = s_;
    s.each([&](size_t p) { s.terms.put(p, pressing(s, p, pressure[p])); });
    s.each_with_pairs(FluidFactor::slope, s.terms, nullptr, [&](size_t p, const FluidVector& sum) {
      const Vec3 force = pressure[p] * s.gradient[p] + pressed(s, p, sum);
      s.acceleration.set(p, -(1 / s.density[p]) * force);
    });
  }
  /// Adds to a flow what walls do.
  void lever(size_t p, SingleVector& flow) {
    const double volume = double(to_.volumes[p]);
    const Vec3 more = volume * levered(p, 1 / volume * vector(flow));
    flow = {flow.x + float(more[0]), flow.y + float(more[1]), flow.z + float(more[2]), 0};
  }
  bool touched(size_t p) const { return s_.first_touch[p] != s_.first_touch[p + 1]; }
  /// What walls add to a particle's acceleration by pressures.
  Vec3 levered(size_t p, const Vec3& acceleration) {
    Vec3 sum = Vec3::Zero();
    for (size_t k = s_.first_touch[p]; k < s_.first_touch[p + 1]; ++k) {
      WallTouch& t = s_.touches[k];
      t.levered = t.lever * t.normal.dot(acceleration);
      sum += t.levered * t.normal;
    }
    return sum;
  }
  const Vec3& gradient(const WallTouch& t) const { return corrected_ ? t.corrected : t.gradient; }
  double opened_by_bodies(size_t p) const {
    double rate = 0;
    if (bodies_yield_)
      for (const WallTouch& t : s_.touches_of(p))
        rate -= s_.response_at(responses_, t.body, s_.x(p)).dot(gradient(t));
    return rate;
  }
  template <class F>
  std::vector<Wrench> on_bodies(const F& pressure) const {
    const FluidState& s = s_;
    return s.sum_wrenches([&](size_t p, std::span<Wrench> to) {
      const double own = pressure(p);
      for (const WallTouch& t : s.touches_of(p)) {
        Vec3 force = own * gradient(t);
        if (corrected_) force -= s.density[p] * t.levered * t.normal;
        s.add_force(to, t.body, s.x(p), s.volume[p] * force);
      }
    });
  }

  FluidState& s_;
  PressureOperands& to_;
  bool corrected_, bodies_yield_ = false;
  std::vector<Wrench> responses_;  ///< what bodies make of the forces
};

/// Finds pressures such that no share is too large by more than the error in the mean, which is
/// h^2 (source + opening), and where there is pressure none too small; `source` [1/s2] by place. By
/// projected gradients along the diagonal with Anderson's acceleration (Walker and Ni, "Anderson
/// acceleration for fixed-point iterations", 2011; Mai and Johansson, "Anderson acceleration of
/// proximal gradient methods", 2020): of all combinations of the last pressures whose weights sum
/// to one, the one whose step would be shortest if steps were linear, and that step. Where no
/// pressure comes to be zero these are minimal residuals, and unlike conjugate gradients they need
/// no product besides that with the pressures themselves where some do.
///
/// Steps are as long as the stiffest wave of a lattice allows; where the error grows, also what
/// Rayleigh's quotient of the last change says: beside walls, and where particles lie closely,
/// there are stiffer ones. Gives the number of iterations.
class PressureSolve {
 public:
  /// `error`: where iterations end, as a share of density [-].
  PressureSolve(FluidState& s, const std::vector<double>& source, std::vector<double>& pressure,
                PressureForces& forces, double error, FluidTrace::Solve* trace)
      : s_(s),
        error_(error),
        trace_(trace),
        pressure_(pressure),
        forces_(forces),
        sought_(s.pressure_operands.sought),
        weights_(s.pressure_operands.weights) {
    sought_.resize(s.size());
    s.each([&](size_t p) {
      const auto own = float(pressure[p]), diagonal = float(forces.diagonal(p));
      const auto volume = float(s.kernel.scale() * s.volume[p]);
      sought_[p] = {own,    0, 0, float(source[p]), diagonal, diagonal > 0 ? 1 / diagonal : 0,
                    volume, {}};
      weights_[p] = volume * own;
    });
  }

  int run() {
    s_.each([&](size_t p) { forces_.press(p); });
    PassSums sums;
    for (int iterations = 0;; ++iterations) {
      forces_.find([&](size_t p) { return double(sought_[p].now); });
      const double last = sums.square[0];
      sums = pass(iterations == 0);
      const double error = s_.h * s_.h * sums.wrong / double(s_.size());
      if (iterations > 0 && error > s_.report.density_error) note_stiffness(sums);
      s_.report.density_error = error;
      if (trace_) note(iterations, error);
      // What was stopped is thrown away by who asked for it, at the next sub-step.
      if (error <= error_ || iterations >= s_.common.most_iterations || stop_requested()) {
        s_.each([&](size_t p) { pressure_[p] = double(sought_[p].now); });
        return iterations;
      }
      sums.square[1] = last;
      step_on(shortest(sums));
    }
  }

 private:
  /// Inner products are those of M = volumes times diagonals. Of the last change of pressures and
  /// the one before it, by how much steps changed with them:
  struct PassSums {
    double wrong = 0;  ///< how far pressures are from the solution [1/s2]
    double square[2] = {0, 0}, product = 0;
    double along[2] = {0, 0};    ///< with the step
    double bent = 0, moved = 0;  ///< Rayleigh's quotient of the change of pressures
  };
  /// How much of the last two changes of pressures is taken back [-].
  using Shares = std::array<float, 2>;

  /// How far from its solution a pressure is: excess, or pressure that is more than it takes.
  static float wrong(const SoughtPressure& of) {
    return of.residual > 0 ? of.residual : std::min(-of.residual, of.diagonal * of.now);
  }
  /// Residuals and steps of the pressures whose flows were found; the first ones changed nothing.
  PassSums pass(bool first) {
    const auto length = float(tolerances::gradient_step / s_.stiffest);
    std::array<PassSums, chunk_count> parts{};
    forces_.open([&](size_t chunk, size_t p, double rate) {
      SoughtPressure& of = sought_[p];
      PassSums& sums = parts[chunk];
      const float residual = of.source + float(rate), change = of.changes[0].pressure;
      sums.bent += double(of.volume * change * (of.residual - residual));
      sums.moved += double(of.volume * of.diagonal * change * change);
      of.residual = residual;
      sums.wrong += double(wrong(of));
      const float step = std::max(0.0f, of.now + length * residual * of.per_diagonal) - of.now;
      of.changes[0].step = first ? 0 : step - of.step;
      of.step = step;
      const float mass = of.volume * of.diagonal, last = mass * of.changes[0].step,
                  before = mass * of.changes[1].step;
      sums.square[0] += double(last * of.changes[0].step);
      sums.product += double(last * of.changes[1].step);
      sums.along[0] += double(last * step);
      sums.along[1] += double(before * step);
    });
    PassSums total;
    for (const PassSums& part : parts) {
      total.wrong += part.wrong, total.product += part.product;
      total.bent += part.bent, total.moved += part.moved;
      for (size_t k = 0; k < 2; ++k)
        total.square[k] += part.square[k], total.along[k] += part.along[k];
    }
    return total;
  }
  /// Which shares leave the shortest step, by the normal equations.
  static Shares shortest(const PassSums& sums) {
    const double a = sums.square[0], b = sums.square[1], c = sums.product;
    const double determinant = a * b - c * c;
    if (determinant > tolerances::least_angle * a * b)
      return {float((b * sums.along[0] - c * sums.along[1]) / determinant),
              float((a * sums.along[1] - c * sums.along[0]) / determinant)};
    return {a > 0 ? float(sums.along[0] / a) : 0, 0};
  }
  void step_on(const Shares& shares) {
    s_.each([&](size_t p) {
      SoughtPressure& of = sought_[p];
      float next = of.now + of.step;
      for (size_t k = 0; k < 2; ++k)
        next -= shares[k] * (of.changes[k].pressure + of.changes[k].step);
      next = std::max(0.0f, next);
      of.changes[1] = of.changes[0];
      of.changes[0].pressure = next - of.now;
      of.now = next;
      weights_[p] = of.volume * next;
      forces_.press(p);
    });
  }
  void note_stiffness(const PassSums& sums) {
    if (sums.bent > s_.stiffest * sums.moved && sums.moved > 0)
      s_.stiffest = sums.bent / sums.moved;
  }
  void note(int number, double error) const {
    trace_->enough = error_;
    std::vector<FluidTrace::Iteration>& all = trace_->iterations;
    if (all.size() == FluidTrace::most_kept) all.pop_back();
    FluidTrace::Iteration& now = all.emplace_back();
    now.number = number;
    now.error = error;
    now.wrong.resize(s_.size());
    for (size_t p = 0; p < s_.size(); ++p)
      now.wrong[s_.lists.order()[p]] = float(s_.h * s_.h * double(wrong(sought_[p])));
  }

  FluidState& s_;
  double error_;
  FluidTrace::Solve* trace_;
  std::vector<double>& pressure_;
  PressureForces& forces_;
  std::vector<SoughtPressure>& sought_;
  std::vector<float>& weights_;
};

}  // namespace

void solve_pressure(FluidState& s) {
  place_rows(s);
  PressureForces forces(s, s.corrects() ? Sums::corrected : Sums::of_shares, true);
  forces.take_operands();
  std::vector<double>& source = s.pressure_operands.source;
  source.resize(s.size());
  // Where there is room, the fluid may use it up.
  s.each([&](size_t p) { source[p] = std::min(0.0, s.share[p] - 1) / (s.h * s.h); });
  forces.take_velocities(source);
  const double error = tolerances::rate_share * s.common.density_error;
  s.report.pressure_iterations +=
      PressureSolve(s, source, s.pressure, forces, error, s.trace ? &s.trace->pressure : nullptr)
          .run();
  forces.find_exactly(s.pressure);
  forces.act(s.pressure);
}

// The rows are those of solve_pressure.
//
// Shares are linear in places only nearby, and a particle whose share hardly depends on its place,
// as one that has come into a wall, would be thrown anywhere: the shift is no longer than the way
// that the Courant condition allows in a sub-step.
void shift_particles(FluidState& s) {
  PressureForces forces(s, Sums::of_shares, false);
  forces.take_operands();
  std::vector<double>& source = s.pressure_operands.source;
  s.each([&](size_t p) { source[p] = (s.share[p] - 1) / (s.h * s.h); });
  forces.take_velocities(source);
  s.report.shift_iterations +=
      PressureSolve(s, source, s.shift_pressure, forces, s.common.density_error,
                    s.trace ? &s.trace->shift : nullptr)
          .run();
  const double longest = s.common.cfl * s.spacing / s.h;
  s.each([&](size_t p) {
    const Vec3 shift = s.h * forces.acceleration(p);
    const double length = shift.norm();
    s.shift.set(p, length > longest ? Vec3(longest / length * shift) : shift);
  });
}

void press_by_state(FluidState& s, double sound_speed) {
  s.each([&](size_t p) {
    const double stiffness =
        s.density[p] * sound_speed * sound_speed / double(tolerances::tait_exponent);
    double power = 1;
    for (int k = 0; k < tolerances::tait_exponent; ++k) power *= s.share[p];
    s.pressure[p] = std::max(0.0, stiffness * (power - 1));
  });
  PressureForces forces(s, Sums::of_shares, true);
  s.report.density_error =
      s.sum([&](size_t p) { return std::max(0.0, s.share[p] - 1); }) / double(s.size());
  forces.find_exactly(s.pressure);
  forces.act(s.pressure);
}

}  // namespace tumble
