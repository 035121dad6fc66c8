// Pressures p >= 0 of the particles of an incompressible fluid. With D the operator that makes
// rates of shares of velocities (FluidState::rate), V D^T p are the forces of pressures, so that D
// M^-1 D^T is symmetric, with the bodies' masses in M: the velocities that they leave are the
// nearest to those before that are allowed, and have no more energy.
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
#include "engine/dynamics/sph/block_sums.hpp"
#include "engine/dynamics/sph/fluid_state.hpp"

#include <cmath>

namespace tumble {
namespace {

/// Of which operator D pressures are: that of shares themselves, or the corrected one of
/// find_corrections.
enum class Sums : uint8_t { of_shares, corrected };

/// Forces of pressures, and what bodies make of them. While pressures are sought they are in single
/// precision, by blocks; what acts in the end is in double, pair by pair equal and opposite.
class PressureForces {
 public:
  PressureForces(FluidState& s, const std::vector<double>& pressure, Sums sums, bool bodies_yield)
      : s_(s),
        pressure_(pressure),
        corrected_(sums == Sums::corrected),
        responses_(s.bodies.size()) {
    if (!bodies_yield) return;
    for (const FluidBody& b : s.body_defs) bodies_yield_ = bodies_yield_ || b.inverse_mass > 0;
  }

  /// What find() and sum_openings() need.
  void take_operands() {
    FluidState& s = s_;
    const double length = s.kernel.reach();
    PressureOperands& to = s.pressure_operands;
    for_chunks(s.crew, s.size(), [&](size_t chunk, size_t, size_t) {
      for (size_t k = 0; k < s.blocks[chunk].size(); ++k) {
        const FluidBlock block = s.blocks[chunk][k];
        for (size_t p = block.first; p < block.first + block.ends.size(); ++p) {
          const SingleVector at =
              single((s.x(p) - block.centre) / length, double(s.first_block[chunk] + k));
          to.flows[p].at = at;
          const double volume = s.kernel.scale() * s.volume[p];
          const Vec3& g = corrected_ ? s.corrected_gradient[p] : s.gradient[p];
          to.gradients[p] = single(length / volume * g, volume / (length * s.density[p]));
          if (!corrected_) continue;
          to.matrices[p].at = at;
          for (int k = 0; k < 3; ++k)
            to.matrices[p].correction[k] = single(s.correction[p].col(k), 0);
        }
      }
    });
    operands_ = {length,          s.block_centres.data(), corrected_ ? to.matrices.data() : nullptr,
                 to.flows.data(), to.weights.data(),      to.gradients.data()};
  }

  void find() {
    FluidState& s = s_;
    const double scale = s.kernel.scale();
    s.each([&](size_t p) {
      s.pressure_operands.weights[p] = float(scale * s.volume[p] * pressure_[p]);
    });
    s.each_block([&](const FluidBlock& block, BlockScratch& scratch) {
      press_block(operands_, block, scratch);
    });
    if (corrected_) lever_flows();
    if (!bodies_yield_) return;
    const std::vector<Wrench> forces = on_bodies();
    for (size_t b = 0; b < forces.size(); ++b) responses_[b] = s.response(b, forces[b]);
  }
  /// Sum of f(p, rate of change of the particle's rate by them [1/s2]) over all particles.
  template <class F>
  double sum_openings(const F& f) const {
    const double per_unit = 1 / operands_.length_unit;
    return s_.sum_blocks([&](const FluidBlock& block, BlockScratch& scratch) {
      std::array<float, tolerances::block_particles> rates;
      open_block(operands_, block, rates.data(), scratch);
      double sum = 0;
      for (size_t k = 0; k < block.ends.size(); ++k) {
        const size_t p = block.first + k;
        sum += f(p, per_unit * double(rates[k]) + opened_by_bodies(p));
      }
      return sum;
    });
  }
  double diagonal(size_t p) const { return corrected_ ? s_.corrected_diagonal[p] : s_.diagonal[p]; }
  /// Accelerations of the fluid, in double.
  void find_exactly() {
    if (corrected_)
      find_corrected();
    else
      find_plain();
  }
  /// They have acted for the sub-step.
  void act() {
    find_exactly();
    s_.report.pressure_work += s_.accelerate();
    std::vector<Wrench> forces = on_bodies();
    for (Wrench& w : forces) w.impulse *= s_.h, w.angular_impulse *= s_.h;
    s_.push_bodies(forces);
  }

 private:
  static SingleVector single(const Vec3& v, double w) {
    return {float(v[0]), float(v[1]), float(v[2]), float(w)};
  }
  void find_plain() {
    FluidState& s = s_;
    s.each([&](size_t p) { s.terms.put(p, pressing(s, p, pressure_[p])); });
    s.each_with_pairs(FluidFactor::slope, s.terms, nullptr, [&](size_t p, const FluidVector& sum) {
      const Vec3 force = pressure_[p] * s.gradient[p] + pressed(s, p, sum);
      s.acceleration.set(p, -(1 / s.density[p]) * force);
    });
  }
  void find_corrected() {
    FluidState& s = s_;
    s.each([&](size_t p) { s.wide_terms.put(p, pressing_corrected(s, p, pressure_[p])); });
    s.each_with_pairs(
        FluidFactor::slope, s.wide_terms, nullptr, [&](size_t p, const FluidTriple& sum) {
          const Vec3 force = pressure_[p] * s.corrected_gradient[p] + pressed(s, p, sum);
          s.acceleration.set(p, -(1 / s.density[p]) * force);
        });
    s.each([&](size_t p) {
      if (touched(p)) s.acceleration.set(p, s.acceleration[p] + levered(p, s.acceleration[p]));
    });
  }
  void lever_flows() {
    FluidState& s = s_;
    s.each([&](size_t p) {
      if (!touched(p)) return;
      SingleVector& u = s.pressure_operands.flows[p].u;
      const double volume = s.kernel.scale() * s.volume[p];
      const Vec3 more =
          volume * levered(p, 1 / volume * Vec3(double(u.x), double(u.y), double(u.z)));
      u = {u.x + float(more[0]), u.y + float(more[1]), u.z + float(more[2]), u.w};
    });
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
  std::vector<Wrench> on_bodies() const {
    const FluidState& s = s_;
    return s.sum_wrenches([&](size_t p, std::span<Wrench> to) {
      for (const WallTouch& t : s.touches_of(p)) {
        Vec3 force = pressure_[p] * gradient(t);
        if (corrected_) force -= s.density[p] * t.levered * t.normal;
        s.add_force(to, t.body, s.x(p), s.volume[p] * force);
      }
    });
  }

  FluidState& s_;
  const std::vector<double>& pressure_;
  bool corrected_, bodies_yield_ = false;
  std::vector<Wrench> responses_;  ///< what bodies make of the forces
  BlockOperands operands_;
};

/// Finds pressures such that no share is too large by more than the error in the mean, which is
/// h^2 (source + opening), and where there is pressure none too small; `source` [1/s2] by place. By
/// projected gradients along the diagonal with Nesterov's acceleration, which begins anew where it
/// leads uphill (O'Donoghue and Candes, "Adaptive restart for accelerated gradient schemes", 2015).
/// Steps are as long as the stiffest wave of a lattice allows; where the error grows, also what
/// Rayleigh's quotient of the last step says: beside walls, and where particles lie closely, there
/// are stiffer ones. Gives the number of iterations.
class PressureSolve {
 public:
  /// `error`: where iterations end, as a share of density [-].
  PressureSolve(FluidState& s, const std::vector<double>& source, std::vector<double>& pressure,
                PressureForces& forces, double error, FluidTrace::Solve* trace)
      : s_(s),
        error_(error),
        trace_(trace),
        source_(source),
        pressure_(pressure),
        forces_(forces),
        residual_(s.size()),
        residual_before_(s.size()),
        before_(s.size()),
        last_(pressure.begin(), pressure.begin() + ptrdiff_t(s.size())) {}

  int run() {
    forces_.take_operands();
    double momentum = 1;
    for (int iterations = 0;; ++iterations) {
      forces_.find();
      residual_.swap(residual_before_);
      const double wrong = forces_.sum_openings([&](size_t p, double rate) {
        residual_[p] = source_[p] + rate;
        return this->wrong(p);
      });
      const double error = s_.h * s_.h * wrong / double(s_.size());
      if (iterations > 0 && error > s_.report.density_error) note_stiffness();
      s_.report.density_error = error;
      if (trace_) note(iterations, s_.report.density_error);
      // What was stopped is thrown away by who asked for it, at the next sub-step.
      if (s_.report.density_error <= error_ || iterations >= s_.common.most_iterations ||
          stop_requested())
        return iterations;
      const double next = 0.5 * (1 + std::sqrt(1 + 4 * momentum * momentum));
      const bool uphill = advance((momentum - 1) / next);
      momentum = uphill ? 1 : next;
    }
  }

 private:
  /// How far from its solution each is: excess, or pressure that is more than it takes.
  double wrong(size_t p) const {
    const double own = forces_.diagonal(p) * pressure_[p];
    return residual_[p] > 0 ? residual_[p] : std::min(-residual_[p], own);
  }
  /// Rayleigh's quotient of the last change of pressures.
  void note_stiffness() {
    const auto change = [&](size_t p) { return pressure_[p] - before_[p]; };
    const double bent = s_.sum(
        [&](size_t p) { return s_.volume[p] * change(p) * (residual_before_[p] - residual_[p]); });
    const double moved = s_.sum(
        [&](size_t p) { return s_.volume[p] * forces_.diagonal(p) * change(p) * change(p); });
    if (bent > s_.stiffest * moved && moved > 0) s_.stiffest = bent / moved;
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
      now.wrong[s_.lists.order()[p]] = float(s_.h * s_.h * wrong(p));
  }
  /// A step along the gradient, and `keep` of the way from the point before to its end.
  bool advance(double keep) {
    const double along = s_.sum([&](size_t p) {
      double& to = stepped(p);
      return s_.volume[p] * residual_[p] * (to - last_[p]);
    });
    const bool uphill = along < 0;
    s_.each([&](size_t p) {
      const double to = next_[p];
      before_[p] = pressure_[p];
      pressure_[p] = uphill ? to : std::max(0.0, to + keep * (to - last_[p]));
      last_[p] = to;
    });
    return uphill;
  }
  double& stepped(size_t p) {
    double& to = next_[p];
    to = pressure_[p];
    if (forces_.diagonal(p) > 0)
      to = std::max(
          0.0, to + tolerances::gradient_step / s_.stiffest * residual_[p] / forces_.diagonal(p));
    return to;
  }

  FluidState& s_;
  double error_;
  FluidTrace::Solve* trace_;
  const std::vector<double>& source_;
  std::vector<double>& pressure_;
  PressureForces& forces_;
  std::vector<double> residual_, residual_before_, before_, last_,
      next_ = std::vector<double>(residual_.size());
};

}  // namespace

void solve_pressure(FluidState& s) {
  std::vector<double> source;
  const bool corrects = s.corrects();
  if (corrects)
    find_divergences(s, source);
  else
    find_rates(s, source);
  // Where there is room, the fluid may use it up.
  s.each(
      [&](size_t p) { source[p] = std::min(0.0, s.share[p] - 1) / (s.h * s.h) + source[p] / s.h; });
  PressureForces forces(s, s.pressure, corrects ? Sums::corrected : Sums::of_shares, true);
  const double error = tolerances::rate_share * s.common.density_error;
  s.report.pressure_iterations +=
      PressureSolve(s, source, s.pressure, forces, error, s.trace ? &s.trace->pressure : nullptr)
          .run();
  forces.act();
}

// Shares are linear in places only nearby, and a particle whose share hardly depends on its place,
// as one that has come into a wall, would be thrown anywhere: the shift is no longer than the way
// that the Courant condition allows in a sub-step.
void shift_particles(FluidState& s) {
  std::vector<double> source;
  find_rates(s, source);
  s.each([&](size_t p) { source[p] = (s.share[p] - 1) / (s.h * s.h) + source[p] / s.h; });
  PressureForces forces(s, s.shift_pressure, Sums::of_shares, false);
  s.report.shift_iterations +=
      PressureSolve(s, source, s.shift_pressure, forces, s.common.density_error,
                    s.trace ? &s.trace->shift : nullptr)
          .run();
  forces.find_exactly();
  const double longest = s.common.cfl * s.spacing / s.h;
  s.each([&](size_t p) {
    const Vec3 shift = s.h * s.acceleration[p];
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
  PressureForces forces(s, s.pressure, Sums::of_shares, true);
  s.report.density_error =
      s.sum([&](size_t p) { return std::max(0.0, s.share[p] - 1); }) / double(s.size());
  forces.act();
}

}  // namespace tumble
