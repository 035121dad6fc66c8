#include "engine/core/chunks.hpp"
#include "engine/world/state.hpp"

#include <algorithm>
#include <numeric>

namespace tumble {

void BodySums::add(const RigidBody& b, const Vec3& g) {
  if (!b.asleep) ++awake;
  const Vec3 p = b.mass * b.v;
  const Vec3 spin = b.inertia_world() * b.omega;
  kinetic += 0.5 * b.mass * b.v.squaredNorm() + 0.5 * b.omega.dot(spin);
  gravity -= b.gravity_scale * b.mass * g.dot(b.pose.x);
  momentum += p;
  angular_momentum += b.pose.x.cross(p) + spin;
}

void BodySums::add(const BodySums& other) {
  awake += other.awake;
  kinetic += other.kinetic;
  gravity += other.gravity;
  momentum += other.momentum;
  angular_momentum += other.angular_momentum;
}

namespace {

/// Number of bodies whose sums are stored together: the sums of a block are kept while all of its
/// bodies rest.
constexpr size_t block_size = 64;

BodySums sum_block(const WorldState& s, size_t block) {
  const size_t end = std::min((block + 1) * block_size, s.bodies.bodies.size());
  BodySums sum;
  for (size_t i = block * block_size; i < end; ++i)
    if (s.bodies.bodies[i].dynamic()) sum.add(s.bodies.bodies[i], s.settings.gravity.now());
  return sum;
}

/// Finds the blocks to be summed again: all, unless the roster tells which bodies are active.
void find_stale_sums(WorldState& s, size_t blocks) {
  std::vector<uint32_t>& stale = s.sums.stale;
  stale.clear();
  if (s.roster.everything() || s.sums.blocks.size() != blocks) {
    stale.resize(blocks);
    std::iota(stale.begin(), stale.end(), 0u);
    return;
  }
  const Roster& r = s.roster;
  for (const std::span<const uint32_t> slots : {r.active(), r.settled(), r.touched()})
    for (const uint32_t slot : slots) {  // nearly in ascending order
      const auto block = uint32_t(slot / block_size);
      if (stale.empty() || stale.back() != block) stale.push_back(block);
    }
  std::ranges::sort(stale);
  stale.erase(std::unique(stale.begin(), stale.end()), stale.end());
}

/// Sums over all bodies.
BodySums sum_bodies(WorldState& s) {
  const size_t blocks = (s.bodies.bodies.size() + block_size - 1) / block_size;
  find_stale_sums(s, blocks);
  s.sums.blocks.resize(blocks);
  for_chunks(
      s.crew.get(), s.sums.stale.size(),
      [&](size_t, size_t first, size_t last) {
        for (size_t k = first; k < last; ++k)
          s.sums.blocks[s.sums.stale[k]] = sum_block(s, s.sums.stale[k]);
      },
      least_parallel / block_size);
  BodySums sum;
  for (const BodySums& block : s.sums.blocks) sum.add(block);
  return sum;
}

void add_particles(const ParticleSystem& p, const Vec3& g, StepStats& out) {
  out.particles += p.size();
  for (size_t i = 0; i < p.size(); ++i) {
    const Vec3 momentum = p.mass[i] * p.v[i];
    out.energies.kinetic += 0.5 * p.v[i].dot(momentum);
    out.energies.gravity -= p.gravity_scale * p.mass[i] * g.dot(p.x[i]);
    out.momentum += momentum;
    out.angular_momentum += p.x[i].cross(momentum);
  }
  if (!p.grains) return;
  for (size_t i = 0; i < p.size(); ++i) {
    const Vec3 turning = p.moment(i) * p.spin[i];
    out.energies.kinetic += 0.5 * p.spin[i].dot(turning);
    out.angular_momentum += turning;
  }
}

LedgerState ledger_state(const StepStats& stats) {
  return {stats.energies.total(), stats.energies.kinetic, stats.momentum, stats.angular_momentum};
}

}  // namespace

void measure(WorldState& s) {
  StepStats& out = s.stats;
  out.bodies = s.bodies.ids.count();
  out.particles = 0;
  out.energies = {};
  const Vec3 g = s.settings.gravity.now();
  const BodySums sum = sum_bodies(s);
  out.awake = sum.awake;
  out.energies.kinetic = sum.kinetic;
  out.energies.gravity = sum.gravity;
  out.momentum = sum.momentum;
  out.angular_momentum = sum.angular_momentum;
  for (const ParticleSystem& p : s.particles) add_particles(p, g, out);
  const JointEnergies joints = s.joints.energies(s.bodies.bodies);
  out.energies.kinetic += joints.kinetic;
  out.energies.springs += joints.potential;
  out.joints = s.joints.ids.count();
  const ForceContext context = s.force_context();
  for (const auto& force : s.forces)
    if (force)
      (anchors(*force).empty() ? out.energies.fields : out.energies.springs) +=
          potential_energy(*force, context);
}

LedgerState measured(const WorldState& s) {
  return ledger_state(s.stats);
}

LedgerState measure_particles(WorldState& s, std::vector<ParticleSystem>& systems) {
  StepStats sum;
  for (const ParticleSystem& p : systems) add_particles(p, s.settings.gravity.now(), sum);
  BodySet no_bodies;
  const ForceContext context{no_bodies, s.particle_ids, systems, s.settings.tick.tick(),
                             s.settings.gravity.now()};
  for (const auto& force : s.forces)
    if (force && field_targets(*force)) sum.energies.fields += potential_energy(*force, context);
  return ledger_state(sum);
}

}  // namespace tumble
