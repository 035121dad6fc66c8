#include "engine/dynamics/forces/pair/pair_force.hpp"

#include "engine/dynamics/forces/pair/pair_sums.hpp"

#include <algorithm>
#include <limits>
#include <memory>

#include <fmt/format.h>

namespace tumble {
namespace {

using PairWeight = double (*)(const void*, const ParticleSystem&, size_t);

/// Sums with their lists, for the potentials that were asked for last: what has the same reach and
/// the same systems shares lists. Which are still there changes no bit.
class KeptSums {
 public:
  PairSums& of(const void* world, std::span<const ParticleSystemId> between, double reach) {
    const auto known = std::ranges::find_if(all_, [&](const std::unique_ptr<Entry>& e) {
      return e->world == world && e->reach == reach && std::ranges::equal(e->between, between);
    });
    if (known == all_.end()) {
      if (all_.size() < most) all_.push_back(std::make_unique<Entry>());
      std::rotate(all_.begin(), all_.end() - 1, all_.end());
      Entry& entry = *all_.front();  // with the memory of the one that it was, if it was one
      entry.world = world, entry.reach = reach;
      entry.between.assign(between.begin(), between.end());
    } else {
      std::rotate(all_.begin(), known, known + 1);
    }
    return all_.front()->sums;
  }

 private:
  static constexpr size_t most = 8;
  struct Entry {
    const void* world = nullptr;
    double reach = 0;  ///< [m]
    std::vector<ParticleSystemId> between;
    PairSums sums;
  };
  std::vector<std::unique_ptr<Entry>> all_;  ///< the one that was asked for last comes first
};

/// The particles that a pair potential acts on, wherever they are kept.
class PairedParticles {
 public:
  PairedParticles(const ForceContext& context, std::span<const ParticleSystemId> between,
                  double lead)
      : context_(context), between_(between) {
    x_.clear(), places_.clear();
    for (uint32_t s = 0; s < context.particles.size(); ++s) {
      if (!context.particle_ids.alive(s)) continue;
      const ParticleSystemId id = context.particle_ids.at(s);
      if (!between.empty() && std::ranges::find(between, id) == between.end()) continue;
      const ParticleSystem& p = context.particles[s];
      box_ = p.box;
      const std::span<const uint32_t> blocks =
          context.only_some() ? context.asked_blocks(s) : std::span<const uint32_t>();
      for (const uint32_t slot : blocks) {
        const RigidBody& b = context.bodies.bodies[slot];
        add(b.pose.x + lead * b.v, {s, slot - context.particle_slots[s], slot});
      }
      if (context.only_some()) continue;
      for (size_t i = 0; i < p.size(); ++i) add(p.x[i] + lead * p.v[i], {s, uint32_t(i), no_slot});
    }
  }

  Status push(const PairLaw& law, PairWeight weight, const void* force) {
    choose(law, weight, force);
    return sums_->push(law, {x_, weights_, box_}, crew());
  }
  Status measure(const PairLaw& law, PairWeight weight, const void* force) {
    choose(law, weight, force);
    return sums_->measure(law, {x_, weights_, box_}, crew());
  }
  void add_forces() const {
    for (size_t k = 0; k < x_.size(); ++k) {
      const Place& at = places_[k];
      (at.slot == no_slot ? context_.particles[at.system].force[at.index]
                          : context_.bodies.bodies[at.slot].force) += sums_->forces()[k];
    }
  }
  /// What the next check of the state finds.
  void spoil() const {
    for (const Place& at : places_)
      (at.slot == no_slot ? context_.particles[at.system].force[at.index]
                          : context_.bodies.bodies[at.slot].force)
          .setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  double energy() const { return sums_->energy(); }
  /// Nobody is asked about: lists that are kept stay as they are.
  bool empty() const { return x_.empty(); }

 private:
  static constexpr uint32_t no_slot = ~uint32_t{0};
  struct Place {
    uint32_t system, index, slot;
  };
  Crew* crew() const { return context_.only_some() ? nullptr : context_.crew; }
  void choose(const PairLaw& law, PairWeight weight, const void* force) {
    weights_.resize(x_.size());
    for (size_t k = 0; k < x_.size(); ++k)
      weights_[k] = weight(force, context_.particles[places_[k].system], places_[k].index);
    sums_ = &kept_.of(&context_.particles, between_, law.cutoff);
  }
  void add(const Vec3& x, const Place& place) {
    x_.push_back(x);
    places_.push_back(place);
  }

  const ForceContext& context_;
  std::span<const ParticleSystemId> between_;
  PairSums* sums_ = nullptr;
  PeriodicBox box_;
  // Memory that is kept: groups of bodies ask at the same time, each on a thread.
  static thread_local std::vector<Vec3> x_;
  static thread_local std::vector<Place> places_;
  static thread_local std::vector<double> weights_;
  static thread_local KeptSums kept_;
};

thread_local std::vector<Vec3> PairedParticles::x_;
thread_local std::vector<PairedParticles::Place> PairedParticles::places_;
thread_local std::vector<double> PairedParticles::weights_;
thread_local KeptSums PairedParticles::kept_;

}  // namespace

void PairEnd::apply_to(PairLaw& law) const {
  if (cutoff > 0) law.cutoff = cutoff;
  law.truncation = truncation;
  law.smooth_from = smooth_from;
}

std::string PairEnd::fault() const {
  if (truncation != Truncation::truncated && !(cutoff > 0))
    return "a potential without a cutoff cannot be shifted or smoothed";
  if (truncation == Truncation::smoothed && !(smooth_from > 0 && smooth_from < cutoff))
    return fmt::format("smooth_from must be between 0 and the cutoff of {} m, got {} m", cutoff,
                       smooth_from);
  return {};
}

void apply_pairs(const PairLaw& law, std::span<const ParticleSystemId> between, PairWeight weight,
                 const void* force, ForceContext& context) {
  PairedParticles particles(context, between, context.momentary ? 0 : context.lead);
  if (particles.empty()) return;
  if (particles.push(law, weight, force))
    particles.add_forces();
  else
    particles.spoil();
}

double pair_energy(const PairLaw& law, std::span<const ParticleSystemId> between, PairWeight weight,
                   const void* force, const ForceContext& context) {
  PairedParticles particles(context, between, 0);
  if (particles.empty()) return 0;
  return particles.measure(law, weight, force) ? particles.energy()
                                               : std::numeric_limits<double>::quiet_NaN();
}

std::string pair_fault(const PairLaw& law, std::span<const ParticleSystemId> between,
                       const ForceContext& context) {
  const ParticleSystem* first = nullptr;
  for (uint32_t s = 0; s < context.particles.size(); ++s) {
    if (!context.particle_ids.alive(s)) continue;
    const ParticleSystemId id = context.particle_ids.at(s);
    if (!between.empty() && std::ranges::find(between, id) == between.end()) continue;
    const ParticleSystem& p = context.particles[s];
    if (first && !(first->box == p.box))
      return fmt::format("'{}' and '{}' are not in the same periodic box", first->name, p.name);
    if (!first) first = &p;
    for (int k = 0; k < 3; ++k)
      if (p.box.along(k) && !(p.box.size[k] >= law.cutoff))
        return law.ends() ? fmt::format(
                                "the cutoff of {} m is longer than the periodic box of '{}', "
                                "which is {} m along axis {}",
                                law.cutoff, p.name, p.box.size[k], k)
                          : fmt::format("'{}' is in a periodic box: give a cutoff", p.name);
  }
  return {};
}

}  // namespace tumble
