#include "engine/world/state.hpp"
#include "engine/world/tick_common.hpp"
#include "engine/world/tolerances.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Energy supplied from outside according to the ledger: by edits, the user, emitters (less what
/// was removed), moving bodies, motors, gravity that follows or followed a course (constant gravity
/// has a potential, and its line is balanced), and forces other than springs. All other lines can
/// only dissipate energy or convert it.
double energy_given(const WorldState& s) {
  double sum = 0;
  for (const LedgerLine line :
       {LedgerLine::edits, LedgerLine::user, LedgerLine::emission, LedgerLine::removal,
        LedgerLine::kinematic, LedgerLine::motors, LedgerLine::past_forces, LedgerLine::gravity})
    sum += s.ledger.line(line).total().balance;
  for (uint32_t i = 0; i < s.ledger.forces().size(); ++i)
    if (i < s.forces.size() && s.forces[i] &&
        (!is_spring(*s.forces[i]) || follows_courses(*s.forces[i])))
      sum += s.ledger.forces()[i].account.total().balance;
  return sum;
}

/// The body or particle with the largest kinetic energy; NaN counts as largest.
struct Fastest {
  double energy = -1;
  std::string name;

  bool more(double e) {
    if (!(e > energy) && !std::isnan(e)) return false;
    energy = e;
    return true;
  }
};

std::string fastest(const WorldState& s) {
  Fastest most;
  for (uint32_t i = 0; i < s.bodies.bodies.size(); ++i)
    if (s.bodies.bodies[i].dynamic() && most.more(s.bodies.bodies[i].kinetic_energy()))
      most.name = body_label(s, i);
  for (const ParticleSystem& p : s.particles)
    for (size_t i = 0; i < p.size(); ++i)
      if (most.more(0.5 * p.mass[i] * p.v[i].squaredNorm()))
        most.name = fmt::format("particle {} of '{}'", p.id[i], p.name);
  return most.name.empty() ? "no body" : most.name;
}

double moving_mass(const WorldState& s) {
  double sum = 0;
  for (const RigidBody& b : s.bodies.bodies) sum += b.mass;
  for (const ParticleSystem& p : s.particles)
    for (const double m : p.mass) sum += m;
  return sum;
}

Error breakdown(const WorldState& s, std::string message) {
  return {ErrorCode::numeric, std::move(message),
          fmt::format("tick {}, {} has most of it", s.tick, fastest(s)),
          "use a smaller tick, softer springs or smaller velocities"};
}

}  // namespace

Status check_energy(const WorldState& s) {
  const StepStats& stats = s.stats;
  const double energy = stats.energies.total();
  if (!std::isfinite(energy) || !stats.momentum.allFinite() || !stats.angular_momentum.allFinite())
    return breakdown(s, "the energy or momentum of the world is not finite");
  // Without that of springs: a spring that the tick does not resolve may be stretched far at its
  // end, and slack after the next one. Unbounded growth shows in the kinetic energy.
  const double moving = energy - stats.energies.springs;
  const double given = energy_given(s), excess = moving - given;
  if (!(excess > tolerances::energy_growth * std::fabs(given))) return {};
  if (excess < 0.5 * moving_mass(s) * tolerances::no_energy_speed * tolerances::no_energy_speed)
    return {};
  return breakdown(s, fmt::format("the world has {:.3g} J, a thousand times what all that moves it "
                                  "has given ({:.3g} J): the motion is unstable",
                                  moving, given));
}

}  // namespace tumble
