#include "engine/dynamics/realtime/solve_island.hpp"

#include "engine/core/stop.hpp"
#include "engine/dynamics/realtime/blows.hpp"
#include "engine/dynamics/realtime/hits.hpp"
#include "engine/dynamics/realtime/integrate_bodies.hpp"
#include "engine/dynamics/realtime/solve_joints.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Alternates restitution and sweeps over joints until all points that bounce have their speed and
/// the impact has spread through the mechanism, and limits its energy to `taken`. One sweep would
/// leave the points of one face at different speeds, and a box that falls flat would turn; without
/// the limit a body that is caught between two walls, each of which is to be left, would gain speed
/// with each sweep. Returns whether anything bounced.
bool bounce(const SolverContext& c, const SolverIsland& island, double hs, double taken) {
  note_speeds(island, 1);
  note_joint_speeds(island);
  remember_velocities(island);
  remember_relaxing(island);
  for (int turn = 0; turn < tolerances::most_bounce_turns; ++turn) {
    const double change = apply_restitution(c, island);
    if (turn == 0) {
      if (change == 0) return false;
      if (!limit_bounces(island)) remember_impulses(island);
    }
    sweep_joints(island, hs, JointPass::relaxing, {0, island.joint_sweeps});
    if (std::max(change, blow_change(island)) < tolerances::bounce_error) break;
  }
  const double share = blow_energy(island).bearable_share(taken);
  if (share < 1) {
    scale_velocities(island, share);
    scale_impulses(island, share);
  }
  return true;
}

/// Softness lets sweeps converge that solve one part of a mechanism after the other. An island that
/// couplings make a single block of has no other part: it is solved exactly, and only the rate at
/// which errors are removed is that of others.
Softness softness_of(const SolverIsland& island, double hs) {
  const bool alone = island.rows.empty() && island.springs.empty() && island.coupled.size() == 1 &&
                     island.coupled.front().joints.size() == island.joints.size();
  Softness out = joint_softness(hs);
  if (alone) out.mass_scale = 1, out.impulse_scale = 0;
  return out;
}

/// To be called after the relaxing pass.
void end_substep(const SolverIsland& island, double hs, bool bounced) {
  sum_joints(island, hs, JointPass::relaxing);
  if (bounced || limit_bounces(island)) recall_impulses(island);
}

/// Solves springs, joints and contacts in turn, until springs change little.
void solve_springs(const SolverIsland& island, double hs, double push_out) {
  const size_t sweeps = std::clamp(tolerances::spring_budget / island.springs.size(),
                                   tolerances::least_spring_sweeps, tolerances::most_spring_sweeps);
  double most = 0, before = 0;
  for (size_t k = 0; k < sweeps; ++k) {
    const double change = sweep_springs(island, k % 2 == 1);
    most = std::max(most, change);
    const bool solved = change <= tolerances::spring_error * tolerances::spring_error * most;
    if (!solved && k + 1 < sweeps) accelerate_springs(island, k == 0 ? 0 : change / before);
    before = change;
    if (!island.joints.empty()) move_onto_joints(island, hs);
    solve_rows(island, hs, push_out, true);
    if (solved) return;
  }
}

}  // namespace

SolveResiduals solve_island(const SolverContext& c, SolverIsland& island, int n) {
  const double hs = c.h / n;
  const double push_out = c.settings->push_out_speed;
  // In islands with joints only, forces act in two halves, which makes the sub-step symmetric and
  // of second order. Contacts need all of the force before them, or they would open in between.
  const bool halves = island.rows.empty() && island.springs.empty();
  const double kick = island.kick = halves ? 0.5 * hs : hs;
  island.joint_softness = softness_of(island, hs);
  prepare_rows(c, island, hs);
  prepare_springs(c, island);
  prepare_joints(c, island, hs);
  const bool measured = bounces(island);
  double taken = 0;
  HitPoints hit;
  const auto note_pass = [&](double share) {
    note_speeds(island, share);
    note_joint_speeds(island);
  };
  const auto add_taken = [&](JointPass pass) {
    taken += taken_by_contacts(island) + taken_by_joints(island, pass);
  };
  for (int i = 0; i < n && !stop_requested(); ++i) {
    if (i > 0) end_substep(island, hs, false);
    if (measured) note_pass(0);
    integrate_velocities(c, island, kick);
    taken += hit_before_motion(c, island, hs, hit);
    if (measured && !hit.empty()) note_pass(0);
    warm_start(island);
    if (!island.springs.empty()) start_springs(c, island, hs, i == 0);
    warm_start_joints(island, hs, JointPass::moving);
    if (island.springs.empty()) {
      move_onto_joints(island, hs);
      solve_rows(island, hs, push_out, true);
    } else {
      solve_springs(island, hs, push_out);
    }
    if (measured) add_taken(JointPass::moving);
    integrate_positions(c, island, hs);
    if (kick < hs) integrate_velocities(c, island, hs - kick);
    refresh_spinning_rows(c, island);
    sum_springs(c, island, hs);
    sum_joints(island, hs, JointPass::moving);
    refresh_joints(c, island, hs);
    taken += hit_after_motion(island, hs, hit);
    if (measured) note_pass(1);
    warm_start_joints(island, hs, JointPass::relaxing);
    relax_joints(island, hs);
    if (!island.joints.empty()) solve_normals(island, hs, push_out);
    solve_rows(island, hs, push_out, false);
    if (island.joints.empty()) solve_friction_again(island);
    if (i + 1 == n) follow_with_armatures(island, hs);
    if (measured) add_taken(JointPass::relaxing);
    sum_impulses(island);
  }
  end_substep(island, hs, measured && bounce(c, island, hs, taken));
  store_springs(c, island);
  const double contacts = store_rows(c, island, hs);
  return {contacts, store_joints(c, island, hs)};
}

}  // namespace tumble
