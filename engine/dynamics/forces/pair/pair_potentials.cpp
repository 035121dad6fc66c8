#include "engine/dynamics/forces/pair/pair_potentials.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {

PairLaw LennardJonesDef::law() const {
  PairLaw law{.kind = PairLaw::Kind::lennard_jones, .strength = epsilon, .length = sigma};
  end.apply_to(law);
  return law;
}

/// Force at sigma: 24 eps / sigma; the strongest pull is a tenth of that. An end there is a wall
/// whose energy depends on where a step happens to land.
std::string LennardJonesDef::fault() const {
  if (end.cutoff > 0 && !(end.cutoff > sigma))
    return fmt::format(
        "the cutoff of {} m is not beyond sigma of {} m, where particles repel ten times harder "
        "than they ever attract: make it 2.5 sigma, or 2^(1/6) sigma for what only repels",
        end.cutoff, sigma);
  return end.fault();
}

PairLaw CoulombDef::law() const {
  PairLaw law{.kind = PairLaw::Kind::inverse_distance, .strength = strength, .length = softening};
  end.apply_to(law);
  return law;
}

PairLaw MutualGravityDef::law() const {
  PairLaw law{.kind = PairLaw::Kind::inverse_distance, .strength = -strength, .length = softening};
  end.apply_to(law);
  return law;
}

PairLaw MorseDef::law() const {
  PairLaw law{
      .kind = PairLaw::Kind::morse, .strength = depth, .length = distance, .steepness = steepness};
  end.apply_to(law);
  return law;
}

PairLaw PairTableDef::law() const {
  PairLaw law{.kind = PairLaw::Kind::table};
  law.table = PairTable(r, energy);
  PairEnd{.cutoff = r.back(), .truncation = truncation, .smooth_from = smooth_from}.apply_to(law);
  return law;
}

std::string PairTableDef::fault() const {
  if (r.size() < 2 || r.size() != energy.size())
    return fmt::format("r and energy must have as many values, at least 2; they have {} and {}",
                       r.size(), energy.size());
  for (size_t k = 0; k < r.size(); ++k) {
    if (!(std::isfinite(r[k]) && r[k] >= 0) || !std::isfinite(energy[k]))
      return fmt::format("r[{}] or energy[{}] is not a finite number", k, k);
    if (k > 0 && !(r[k] > r[k - 1]))
      return fmt::format("r must ascend, but r[{}] is {} m after {} m", k, r[k], r[k - 1]);
  }
  return PairEnd{.cutoff = r.back(), .truncation = truncation, .smooth_from = smooth_from}.fault();
}

}  // namespace tumble
