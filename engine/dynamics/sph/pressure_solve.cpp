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
    to_.flows.resize(s.size()), to_.gradients.resize(s.size()), to_.units.resize(s.size());
    to_.volumes.resize(s.lists.places());
    to_.volumes.back() = 0;
    s.each([&](size_t p) { to_.volumes[p] = float(s.kernel.scale() * s.volume[p]); });
    to_.weights.resize(s.size()), to_.exact_weights.resize(s.size());
    to_.pairs.resize(s.blocks.size());
    const double length = s.kernel.reach();
    s.each_block([&](const FluidBlock& block, size_t chunk) {
      std::vector<BlockPairs>& all = to_.pairs[chunk];
      const size_t room = s.stores[chunk].used() / FluidPairStore::batch + 1;
      if (all.size() < room) all.resize(room);
      make_pairs(points(), block, to_.volumes.data(), pairs(block, chunk),
                 to_.units.data() + block.first, to_.gradients.data() + block.first);
      for (size_t p = block.first; p < block.first + block.ends.size(); ++p) {
        const double volume = s.kernel.scale() * s.volume[p];
        Vec3 walls = Vec3::Zero();
        for (const WallTouch& t : s.touches_of(p)) walls += gradient(t);
        SingleVector& g = to_.gradients[p];
        const Vec3 sum = Vec3(double(g.x), double(g.y), double(g.z)) + length * walls;
        g = single(1 / volume * sum, volume / (length * s.density[p]));
      }
    });
  }

  /// Rates of shares by the velocities that are [1/s]; of corrected sums minus their divergence:
  /// fluid behind a wall moves as the mirror image.
  void find_rates(std::vector<double>& rates) {
    FluidState& s = s_;
    s.each([&](size_t p) { to_.flows[p] = single(s.kernel.scale() * s.volume[p] * s.v[p], 0); });
    each_of_copies([&](const BlockCopies& copies, size_t first, size_t last) {
      spread_flows(copies, first, last, to_.flows.data(), to_.rows.data());
    });
    rates.resize(s.size());
    s.each_block([&](const FluidBlock& block, size_t chunk) {
      each_batch(block, chunk, [&](size_t first, std::span<const float> found) {
        for (size_t k = 0; k < found.size(); ++k) {
          const size_t p = first + k;
          double rate = double(found[k]);
          for (const WallTouch& t : s.touches_of(p))
            rate -= s.bodies[t.body].velocity_at(s.x(p)).dot(gradient(t));
          rates[p] = rate;
        }
      });
    });
  }

  /// Particles push their neighbours by the weights that are, for the first time since find_rates.
  void begin() {
    FluidState& s = s_;
    s.each_block([&](const FluidBlock& block, size_t chunk) {
      for (size_t k = 0; k < block.ends.size(); k += tolerances::batch_particles)
        press(block, chunk, k, std::min(block.ends.size(), k + tolerances::batch_particles));
    });
  }
  /// Flows by what particles were pushed by, and of bodies by pressures pressure(p).
  template <class F>
  void find(const F& pressure) {
    each_of_copies([&](const BlockCopies& copies, size_t first, size_t last) {
      flow_by_pushes(copies, first, last, to_.gradients.data(), to_.weights.data(),
                     to_.flows.data(), to_.rows.data());
    });
    if (corrected_) lever_flows();
    if (!bodies_yield_) return;
    const std::vector<Wrench> forces = on_bodies(pressure);
    for (size_t b = 0; b < forces.size(); ++b) responses_[b] = s_.response(b, forces[b]);
  }
  /// f(chunk, p, rate of change of the particle's rate by the flows [1/s2]), which sets the weight
  /// of p; by that the particle pushes. A few particles at a time: the second time their pairs are
  /// read they are still in a near cache.
  template <class F>
  void open_and_press(const F& f) {
    s_.each_block([&](const FluidBlock& block, size_t chunk) {
      each_batch(block, chunk, [&](size_t first, std::span<const float> found) {
        for (size_t k = 0; k < found.size(); ++k)
          f(chunk, first + k, double(found[k]) + opened_by_bodies(first + k));
        press(block, chunk, first - block.first, first - block.first + found.size());
      });
    });
  }
  /// By the flows [m/s2].
  Vec3 acceleration(size_t p) const {
    const SingleVector& u = to_.flows[p];
    return 1 / double(to_.volumes[p]) * Vec3(double(u.x), double(u.y), double(u.z));
  }
  double diagonal(size_t p) const { return corrected_ ? s_.corrected_diagonal[p] : s_.diagonal[p]; }

  /// Accelerations of the fluid, in double.
  void find_exactly(const std::vector<double>& pressure) {
    FluidState& s = s_;
    to_.own.resize(s.size());
    s.each([&](size_t p) { to_.exact_weights[p] = s.volume[p] * pressure[p]; });
    const double unit = s.kernel.scale() / s.kernel.reach();  // of gradients, [1/m4]
    s.each_block([&](const FluidBlock& block, size_t chunk) {
      FluidVector* rows = to_.exact_rows.data() + to_.first_row[chunk] + block.first_row;
      for (size_t r = 0; r < block.rows.size(); ++r) rows[r] = {0, 0, 0, s.volume[block.rows[r]]};
      press_exactly(points(), block, to_.exact_weights.data(), rows, to_.own.data() + block.first);
    });
    s.each([&](size_t p) {
      Vec3 force = unit / s.volume[p] * to_.own[p].vector();
      for (size_t k = to_.first_copy[p]; k < to_.first_copy[p + 1]; ++k)
        force -= unit * to_.exact_rows[to_.copies[k]].vector();
      for (const WallTouch& t : s.touches_of(p)) force += pressure[p] * gradient(t);
      const Vec3 plain = -(1 / s.density[p]) * force;
      s.acceleration.set(p, corrected_ && touched(p) ? Vec3(plain + levered(p, plain)) : plain);
    });
  }
  /// The same of plain sums, without blocks.
  void find_from_lists(const std::vector<double>& pressure) {
    FluidState& s = s_;
    s.each([&](size_t p) { s.terms.put(p, pressing(s, p, pressure[p])); });
    s.each_with_pairs(FluidFactor::slope, s.terms, nullptr, [&](size_t p, const FluidVector& sum) {
      const Vec3 force = pressure[p] * s.gradient[p] + pressed(s, p, sum);
      s.acceleration.set(p, -(1 / s.density[p]) * force);
    });
  }
  /// Accelerations that were found have acted for the sub-step.
  void act(const std::vector<double>& pressure) {
    s_.report.pressure_work += s_.accelerate();
    std::vector<Wrench> forces = on_bodies([&](size_t p) { return pressure[p]; });
    for (Wrench& w : forces) w.impulse *= s_.h, w.angular_impulse *= s_.h;
    s_.push_bodies(forces);
  }

 private:
  static SingleVector single(const Vec3& v, double w) {
    return {float(v[0]), float(v[1]), float(v[2]), float(w)};
  }
  BlockPoints points() const {
    const SmoothingKernel& kernel = s_.kernel;
    return {s_.at.data(), corrected_ ? s_.correction.data() : nullptr, kernel.reach(),
            kernel.steepest() * kernel.reach() / kernel.scale()};
  }
  /// Particles `first` to `end` of a block push their neighbours by their weights.
  void press(const FluidBlock& block, size_t chunk, size_t first, size_t end) {
    std::array<float, tolerances::batch_particles> weights;
    for (size_t k = first; k < end; ++k)
      weights[k - first] = to_.units[block.first + k] * to_.weights[block.first + k];
    press_pairs(block, pairs(block, chunk), weights.data(), first, end, rows(block, chunk));
  }
  BlockPair* pairs(const FluidBlock& block, size_t chunk) {
    return to_.pairs[chunk][block.first_pair / FluidPairStore::batch].all;
  }
  BlockRow* rows(const FluidBlock& block, size_t chunk) {
    return to_.rows.data() + to_.first_row[chunk] + block.first_row;
  }
  /// f(copies, first, last) for ranges of places.
  template <class F>
  void each_of_copies(const F& f) {
    const BlockCopies copies{to_.first_copy.data(), to_.copies.data()};
    for_chunks(s_.crew, s_.size(),
               [&](size_t, size_t first, size_t last) { f(copies, first, last); });
  }
  /// f(first place, rates by the flows) for a few particles of a block at a time.
  template <class F>
  void each_batch(const FluidBlock& block, size_t chunk, const F& f) {
    std::array<float, tolerances::batch_particles> rates;
    const auto per_unit = float(1 / s_.kernel.reach());
    for (size_t k = 0; k < block.ends.size(); k += rates.size()) {
      const size_t end = std::min(block.ends.size(), k + rates.size()), first = block.first + k;
      open_pairs(block, pairs(block, chunk), rows(block, chunk), k, end, rates.data());
      for (size_t n = 0; n < end - k; ++n) {
        const SingleVector &u = to_.flows[first + n], &g = to_.gradients[first + n];
        rates[n] =
            per_unit * (((u.x * g.x + u.y * g.y) + u.z * g.z) - to_.units[first + n] * rates[n]);
      }
      f(first, {rates.data(), end - k});
    }
  }
  /// Flows beside walls, with what these add.
  void lever_flows() {
    FluidState& s = s_;
    s.each([&](size_t p) {
      if (!touched(p)) return;
      SingleVector& u = to_.flows[p];
      const Vec3 more = double(to_.volumes[p]) * levered(p, acceleration(p));
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
/// projected gradients along the diagonal with Nesterov's acceleration, which begins anew where it
/// leads uphill (O'Donoghue and Candes, "Adaptive restart for accelerated gradient schemes", 2015).
/// Steps are as long as the stiffest wave of a lattice allows; where the error grows, also what
/// Rayleigh's quotient of the last step says: beside walls, and where particles lie closely, there
/// are stiffer ones. Gives the number of iterations.
///
/// An iteration goes through the pairs once: as soon as the residual of a few particles is known
/// they step on, and push their neighbours by the pressures of the next iteration. What the sums
/// over all residuals say of the steps' length and of hills therefore comes an iteration later, and
/// the pressures at which the iterations end are those before the last step.
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
      sought_[p] = {own,   own, own, 0, float(source[p]), diagonal, diagonal > 0 ? 1 / diagonal : 0,
                    volume};
      weights_[p] = volume * own;
    });
  }

  int run() {
    forces_.begin();
    double momentum = 1;
    for (int iterations = 0;; ++iterations) {
      forces_.find([&](size_t p) { return double(sought_[p].now); });
      const double next = 0.5 * (1 + std::sqrt(1 + 4 * momentum * momentum));
      const PassSums sums = pass((momentum - 1) / next);
      const double error = s_.h * s_.h * sums.wrong / double(s_.size());
      if (iterations > 0 && error > s_.report.density_error) note_stiffness(sums);
      s_.report.density_error = error;
      if (trace_) note(iterations, error);
      // What was stopped is thrown away by who asked for it, at the next sub-step.
      if (error <= error_ || iterations >= s_.common.most_iterations || stop_requested()) {
        s_.each([&](size_t p) { pressure_[p] = double(sought_[p].before); });
        return iterations;
      }
      momentum = sums.along < 0 ? 1 : next;
    }
  }

 private:
  struct PassSums {
    double wrong = 0;  ///< how far pressures are from the solution [1/s2]
    double along = 0;  ///< of the step along the way since the last one; below zero uphill
    double bent = 0, moved = 0;  ///< Rayleigh's quotient of the change of pressures
  };
  /// How far from its solution a pressure is: excess, or pressure that is more than it takes.
  static float wrong(const SoughtPressure& of) {
    return of.residual > 0 ? of.residual : std::min(-of.residual, of.diagonal * of.before);
  }
  /// A step along the gradient, and `keep` of the way from the last step's end to its end.
  PassSums pass(double keep) {
    const auto length = float(tolerances::gradient_step / s_.stiffest), kept = float(keep);
    std::array<PassSums, chunk_count> parts{};
    forces_.open_and_press([&](size_t chunk, size_t p, double rate) {
      SoughtPressure& of = sought_[p];
      PassSums& sums = parts[chunk];
      const float residual = of.source + float(rate), change = of.now - of.before;
      sums.bent += double(of.volume * change * (of.residual - residual));
      sums.moved += double(of.volume * of.diagonal * change * change);
      of.residual = residual;
      of.before = of.now;
      sums.wrong += double(wrong(of));
      const float stepped = std::max(0.0f, of.now + length * residual * of.per_diagonal);
      const float way = stepped - of.stepped;
      sums.along += double(of.volume * residual * way);
      of.stepped = stepped;
      of.now = std::max(0.0f, stepped + kept * way);
      weights_[p] = of.volume * of.now;
    });
    PassSums total;
    for (const PassSums& part : parts) {
      total.wrong += part.wrong, total.along += part.along;
      total.bent += part.bent, total.moved += part.moved;
    }
    return total;
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
  PressureForces forces(s, s.corrects() ? Sums::corrected : Sums::of_shares, true);
  forces.take_operands();
  std::vector<double>& source = s.pressure_operands.source;
  forces.find_rates(source);
  // Where there is room, the fluid may use it up.
  s.each(
      [&](size_t p) { source[p] = std::min(0.0, s.share[p] - 1) / (s.h * s.h) + source[p] / s.h; });
  const double error = tolerances::rate_share * s.common.density_error;
  s.report.pressure_iterations +=
      PressureSolve(s, source, s.pressure, forces, error, s.trace ? &s.trace->pressure : nullptr)
          .run();
  forces.find_exactly(s.pressure);
  forces.act(s.pressure);
}

// Shares are linear in places only nearby, and a particle whose share hardly depends on its place,
// as one that has come into a wall, would be thrown anywhere: the shift is no longer than the way
// that the Courant condition allows in a sub-step.
void shift_particles(FluidState& s) {
  PressureForces forces(s, Sums::of_shares, false);
  forces.take_operands();
  std::vector<double>& source = s.pressure_operands.source;
  forces.find_rates(source);
  s.each([&](size_t p) { source[p] = (s.share[p] - 1) / (s.h * s.h) + source[p] / s.h; });
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
  forces.find_from_lists(s.pressure);
  forces.act(s.pressure);
}

}  // namespace tumble
