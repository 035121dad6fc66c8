// Impacts, of bounces and of joint limits, spread through whole mechanisms, in each island by
// itself.
#include "engine/dynamics/realtime/blows.hpp"

#include "engine/dynamics/realtime/solve_joints.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"
#include "engine/dynamics/realtime/wide/wide_island.hpp"

#include <algorithm>

namespace tumble {

/// Adds the changes of the last round in the bundles to the parts. Returns whether anything
/// changed.
bool WideIsland::read_blow_changes() {
  for (size_t i = 0; i < rows_.contacts.size(); ++i) {
    const WideContact& c = rows_.contacts[i];
    if (!c.bounces) continue;
    for (uint32_t lane = 0; lane < c.lanes; ++lane) {
      double& change = parts_[part_of(c.a[lane], c.b[lane])].change;
      change = std::max(change, double(rows_.blow_changes[i][lane]));
    }
  }
  return std::ranges::any_of(parts_, [](const Part& part) { return part.change > 0; });
}

/// In islands where the last round changed little the impact is over: their points bounce no more.
void WideIsland::end_blows() {
  for (Part& part : parts_) part.struck = part.change >= tolerances::bounce_error;
  for (WideContact& c : rows_.contacts) {
    if (!c.bounces) continue;
    c.bounces = false;
    for (uint32_t lane = 0; lane < c.lanes; ++lane) {
      const bool struck = parts_[part_of(c.a[lane], c.b[lane])].struck;
      c.bounces = c.bounces || struck;
      for (uint32_t k = 0; !struck && k < c.count; ++k) rows_.points[c.first + k].bounce[lane] = 0;
    }
  }
}

/// Marks the joints of islands whose `change` is above `least`.
void WideIsland::mark_struck(WideRange joints, double least) {
  for (uint32_t i = joints.begin; i < joints.end; ++i) {
    WideJoint& j = rows_.joints[i];
    j.any_struck = false;
    for (uint32_t lane = 0; lane < wide_lanes; ++lane) {
      const bool struck = lane < j.lanes && parts_[part_of(j.a[lane], j.b[lane])].change > least;
      j.struck[lane] = struck ? 1 : 0;
      j.any_struck = j.any_struck || struck;
    }
  }
}

/// Calls f(impulse, the same before the impact) for all rows of the bundled joints of the islands
/// with is(part).
template <class Is, class F>
void WideIsland::for_impulses_of(const Is& is, const F& f) {
  for (uint32_t i = 0; i < rows_.joints.size(); ++i) {
    WideJoint& j = rows_.joints[i];
    WideRemembered& r = rows_.remembered[i];
    for (uint32_t lane = 0; lane < j.lanes; ++lane) {
      if (!is(parts_[part_of(j.a[lane], j.b[lane])])) continue;
      for (size_t k = 0; k < 3; ++k) {
        f(j.moving[k][lane], r.moving[k][lane]);
        f(j.relaxing[k][lane], r.relaxing[k][lane]);
      }
      if (j.hinge == WideJoint::no_hinge) continue;
      WideHinge& h = rows_.hinges[j.hinge];
      for (size_t k = 0; k < 2; ++k) {
        f(h.moving[k][lane], r.turning_moving[k][lane]);
        f(h.relaxing[k][lane], r.turning_relaxing[k][lane]);
      }
    }
  }
}

/// As remember_impulses.
template <class Is>
void WideIsland::remember(const Is& is) {
  if (std::ranges::none_of(parts_, is)) return;
  rows_.remembered.resize(rows_.joints.size());
  for_impulses_of(is, [](float now, float& before) { before = now; });
  for (Part& part : parts_) {
    if (!is(part)) continue;
    remember_impulses(rest_of(part));
    part.remembered = true;
  }
}

/// To be called after the relaxing pass.
void WideIsland::end_substep(Crew& crew, double hs) {
  sum_all_joints(crew, hs, JointPass::relaxing);
  if (std::ranges::any_of(parts_, &Part::blown)) {
    for_impulses_of([](const Part& part) { return part.blown; },
                    [](float& now, float before) { now = before; });
    for (const Part& part : parts_)
      if (part.blown) recall_impulses(rest_of(part));
  }
  for (Part& part : parts_) part.remembered = part.blown = false;
}

/// Alternates restitution and sweeps over joints, as in precise islands, in each island until its
/// impact has spread through the mechanism.
void WideIsland::bounce_in_turn(const SolverContext& c, Crew& crew, double hs) {
  for (Part& part : parts_) part.struck = true;
  if (books_.open) remember_before_blow();
  for (int turn = 0; turn < tolerances::most_bounce_turns; ++turn) {
    for (Part& part : parts_) part.change = 0;
    with_rest([&](const SolverIsland&) {
      for (Part& part : parts_)
        if (part.struck) part.change = apply_restitution(c, rest_of(part));
    });
    bounce_bundles(crew);
    if (!read_blow_changes()) break;
    remember([](const Part& part) { return part.change > 0 && !part.remembered; });
    solve_struck_joints(crew, hs, JointPass::relaxing, 0);
    for (Part& part : parts_) {
      if (!(part.change > 0)) continue;
      part.blown = true;
      part.change = std::max(part.change, blow_change(rest_of(part)));
    }
    end_blows();
  }
  if (books_.open) bound_blows();
}

/// As in solve_joints: where a bouncing limit may be reached, the velocities of joints without it.
void WideIsland::find_free_speeds(Crew& crew, double hs) {
  if (drives_.empty()) return;
  const auto near = [](const Part& part) { return part.change > 0; };
  for (Part& part : parts_) part.change = nears_limit(rest_of(part)) ? 1 : 0;
  if (std::ranges::none_of(parts_, near)) return;
  solve_struck_joints(crew, hs, JointPass::moving, 0);
  remember(near);
  with_rest([&](const SolverIsland&) {
    for (const Part& part : parts_)
      if (near(part)) put_limits(rest_of(part), hs);
  });
}

/// As in solve_joints: spreads the impacts of limits, after their first sweep, through whole
/// mechanisms.
void WideIsland::follow_limits(Crew& crew, double hs) {
  if (drives_.empty()) return;
  for (Part& part : parts_) part.blown = limit_bounces(rest_of(part));
  for (int turn = 1; turn < tolerances::most_bounce_turns; ++turn) {
    for (Part& part : parts_) part.change = part.blown ? blow_change(rest_of(part)) : 0;
    if (std::ranges::none_of(
            parts_, [](const Part& part) { return part.change > tolerances::bounce_error; }))
      return;
    solve_struck_joints(crew, hs, JointPass::relaxing, tolerances::bounce_error);
  }
}

}  // namespace tumble
