#pragma once
#include "engine/core/parameters.hpp"
#include "engine/dynamics/forces/force_context.hpp"
#include "engine/dynamics/forces/pair/pair_law.hpp"
#include "engine/math/varying.hpp"

#include <span>
#include <string>
#include <vector>

namespace tumble {

/// A force between every two particles of some systems, by a law of their distance: `between` names
/// the systems (all where it is empty), `law()` gives the law, `weight(system, i)` what a particle
/// counts for in it.
template <class T>
concept PairForce = requires(const T& f, const ParticleSystem& p, size_t i) {
  f.between;
  f.law();
  f.weight(p, i);
};

/// Where a pair potential ends; see Truncation.
struct PairEnd {
  double cutoff = 0;  ///< [m]; 0: nowhere
  Truncation truncation = Truncation::truncated;
  double smooth_from = 0;  ///< [m]

  void apply_to(PairLaw& law) const;
  /// What is wrong beyond ranges; empty when nothing is.
  std::string fault() const;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.cutoff, {.name = "cutoff",
                       .unit = "m",
                       .min = 0,
                       .doc = "particles farther apart do nothing to each other; 0: all do"});
    v.field(
        d.truncation,
        {.name = "truncation",
         .doc = "how the energy ends at the cut-off: it jumps (truncated), is less by what it is "
                "there (shifted), or falls to zero from smooth_from on (smoothed)"});
    v.field(d.smooth_from, {.name = "smooth_from",
                            .unit = "m",
                            .min = 0,
                            .doc = "smoothed: from here on the energy falls to zero"});
  }
};

/// Adds what pairs of particles do to each other to the force sums; with ForceContext::only, those
/// particles that are blocks of bodies among these. Particles that coincide, where the law has no
/// value, get forces that are no numbers, which the step finds.
void apply_pairs(const PairLaw& law, std::span<const ParticleSystemId> between,
                 double (*weight)(const void* force, const ParticleSystem& system, size_t i),
                 const void* force, ForceContext& context);
/// Their potential energy [J].
double pair_energy(const PairLaw& law, std::span<const ParticleSystemId> between,
                   double (*weight)(const void* force, const ParticleSystem& system, size_t i),
                   const void* force, const ForceContext& context);
/// Whether these systems exist, and lie in one periodic box that is no shorter than the cut-off.
/// Empty when all is well.
std::string pair_fault(const PairLaw& law, std::span<const ParticleSystemId> between,
                       const ForceContext& context);

template <PairForce Def>
double pair_weight(const void* force, const ParticleSystem& system, size_t i) {
  return static_cast<const Def*>(force)->weight(system, i);
}
template <PairForce Def>
void apply(const Def& def, ForceContext& context) {
  apply_pairs(def.law(), def.between, &pair_weight<Def>, &def, context);
}
template <PairForce Def>
double potential_energy(const Def& def, const ForceContext& context) {
  return pair_energy(def.law(), def.between, &pair_weight<Def>, &def, context);
}

}  // namespace tumble
