// The sub-steps of ordinary islands.
#include "engine/dynamics/realtime/wide/wide_island.hpp"

#include "engine/core/crew.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/realtime/integrate_bodies.hpp"
#include "engine/dynamics/realtime/solve_joints.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"
#include "engine/dynamics/realtime/wide/wide_kernels.hpp"

#include <algorithm>

namespace tumble {
namespace {

constexpr uint32_t chunk_size = 8;  ///< bundles (also of bodies) that a thread takes at once

/// Calls f(WideRange) for chunks of [begin, end).
template <class F>
void each_chunk(Crew& crew, WideRange range, const F& f, uint32_t size = chunk_size) {
  const uint32_t n = range.end - range.begin;
  crew.each((n + size - 1) / size, [&](size_t i) {
    const uint32_t begin = range.begin + uint32_t(i) * size;
    f(WideRange{begin, std::min(begin + size, range.end)});
  });
}

/// The same for short loops with equal cost per bundle: one range for each thread.
template <class F>
void each_share(Crew& crew, WideRange range, const F& f) {
  const uint32_t n = range.end - range.begin, threads = uint32_t(crew.threads());
  each_chunk(crew, range, f, std::max(1u, (n + threads - 1) / threads));
}

WideSoftness narrowed(const Softness& s) {
  return {float(s.bias_rate), float(s.mass_scale), float(s.impulse_scale)};
}

WideStep wide_step(const SolverContext& c, double hs) {
  const RealtimeSettings& s = *c.settings;
  const ContactSoftness soft = contact_softness(s, hs);
  return {float(hs),           float(s.push_out_speed), float(s.restitution_threshold),
          narrowed(soft.soft), narrowed(soft.hard),     float(joint_softness(hs).bias_rate)};
}

}  // namespace

SolverIsland WideIsland::rest() {
  SolverIsland rest{bodies_, motions_, rest_rows_, rest_points_, joints_};
  rest.joint_sweeps = tolerances::ordinary_joint_sweeps;
  rest.drives = drives_;
  rest.kick = kick_;
  rest.joint_softness = joint_softness_;
  return rest;
}

SolverIsland WideIsland::rest_of(const Part& part) {
  const auto own = [](auto of_all, const WideRange& r) {
    return of_all.subspan(r.begin, r.end - r.begin);
  };
  SolverIsland out = rest();
  out.rows = own(out.rows, part.rows);
  out.joints = own(out.joints, part.joints);
  return out;
}

SolverIsland WideIsland::special() {
  return {std::span(bodies_).first(special_), std::span(motions_).first(special_), {}, {}, {}, 1};
}

SolveResiduals WideIsland::solve(const SolverContext& c, Crew& crew) {
  SolveResiduals left;
  crew.gather([&] {
    const double hs = c.h / c.settings->substeps;
    kick_ = kick_time(hs);
    joint_softness_ = {joint_softness(hs).bias_rate};
    const WideStep step = wide_step(c, hs);
    prepare(c, crew, step, hs);
    open_blow_books();
    for (int i = 0; i < c.settings->substeps && !stop_requested(); ++i) {
      if (i > 0) end_substep(crew, hs);
      substep(c, crew, step, hs, i);
    }
    bounce(c, crew, hs);
    end_substep(crew, hs);
    left = store(c, crew, hs);
  });
  return left;
}

/// Calls f(begin, end) for ranges of bodies, by whole bundles.
template <class F>
void WideIsland::each_block(Crew& crew, uint32_t bodies, const F& f) {
  constexpr auto lanes = uint32_t(wide_lanes);
  each_chunk(crew, {0, (bodies + lanes - 1) / lanes},
             [&](WideRange r) { f(r.begin * lanes, std::min(r.end * lanes, bodies)); });
}

template <class F>
void WideIsland::each_colour(Crew& crew, const F& f) {
  for (const WideRange& colour : colours_) each_share(crew, colour, f);
}

void WideIsland::prepare(const SolverContext& c, Crew& crew, const WideStep& step, double hs) {
  const auto bodies = uint32_t(slots_.size());
  rows_.bodies.resize(bodies);
  rows_.masses.resize(bodies);
  rows_.motions.resize(simple_ / wide_lanes);
  rows_.contacts.resize(bundles_.size());
  rows_.points.resize(bundled_points_);
  rows_.turnings.resize(turning_bundles_);
  joint_bundles_.resize(rows_);
  each_block(crew, bodies, [&](uint32_t begin, uint32_t end) { stage_bodies(c, hs, begin, end); });
  each_chunk(crew, all_bundles(), [&](WideRange r) {
    stage_contacts(c, r);
    wide_prepare(rows_, r, step);
  });
  each_chunk(crew, all_joints(), [&](WideRange r) {
    joint_bundles_.stage(c, r, fixed_, hs, rows_);
    wide_prepare_joints(rows_, r, step);
  });
  stage_rest(c, hs);
}

/// Applies forces over `h` to the bodies that the kernels integrate.
void WideIsland::kick(Crew& crew, double h) {
  each_share(crew, {0, simple_ / uint32_t(wide_lanes)},
             [&](WideRange r) { wide_kick(rows_, r, float(h)); });
}

void WideIsland::warm_start_bundled_joints(Crew& crew, const WideStep& step, JointPass pass) {
  for (const WideRange& colour : joint_bundles_.colours())
    each_share(crew, colour, [&](WideRange r) { wide_warm_start_joints(rows_, r, step, pass); });
}

void WideIsland::sum_all_joints(Crew& crew, double hs, JointPass pass) {
  if (!joints_.empty()) sum_joints(rest(), hs, pass);
  each_chunk(crew, all_joints(), [&](WideRange r) { wide_sum_joints(rows_, r, pass); });
}

/// Sweeps like sweep_joints.
template <class F>
void WideIsland::sweep_bundled_joints(Crew& crew, JointSweeps which, const F& f) {
  const std::span<const WideRange> colours = joint_bundles_.colours();
  for (int k = which.begin; k < which.end; ++k)
    for (size_t i = 0; i < colours.size(); ++i)
      each_share(crew, colours[k % 2 == 0 ? i : colours.size() - 1 - i], f);
}

void WideIsland::solve_bundled_joints(Crew& crew, JointPass pass) {
  sweep_bundled_joints(crew, sweeps_of(pass, tolerances::ordinary_joint_sweeps),
                       [&](WideRange r) { wide_solve_joints(rows_, r, pass); });
}

/// Sweeps over all joints of the islands whose `change` is above `least`, and no others.
void WideIsland::solve_struck_joints(Crew& crew, double hs, JointPass pass, double least) {
  constexpr JointSweeps sweeps{0, tolerances::ordinary_joint_sweeps};
  each_chunk(crew, all_joints(), [&](WideRange r) { mark_struck(r, least); });
  with_rest([&](const SolverIsland&) {
    for (const Part& part : parts_)
      if (part.change > least) sweep_joints(rest_of(part), hs, pass, sweeps);
  });
  sweep_bundled_joints(crew, sweeps,
                       [&](WideRange r) { wide_solve_struck_joints(rows_, r, pass); });
}

/// Applies forces over `h`, and the impulses of the previous sub-step as a warm start.
void WideIsland::start(const SolverContext& c, Crew& crew, const WideStep& step, double h) {
  kick(crew, h);
  with_rest([&](const SolverIsland& rest) {
    integrate_velocities(c, special(), h);
    warm_start(rest);
    warm_start_joints(rest, double(step.hs), JointPass::moving);
  });
  warm_start_bundled_joints(crew, step, JointPass::moving);
  each_colour(crew, [&](WideRange r) { wide_warm_start(rows_, r); });
}

void WideIsland::substep(const SolverContext& c, Crew& crew, const WideStep& step, double hs,
                         int index) {
  const double push_out = c.settings->push_out_speed;
  const double before = kick_, after = hs - before;
  if (books_.open) note_blow_speeds(0);
  // Lever arms and masses of bundled contacts are those of the start of the tick; if there is
  // nothing else, the impulses of the previous sub-step change velocities as they did then.
  if (index > 0 && sort_ == WideSort::plain) {
    each_share(crew, {0, simple_ / uint32_t(wide_lanes)},
               [&](WideRange r) { wide_kick_again(rows_, r, step.hs); });
  } else {
    start(c, crew, step, before);
  }
  find_free_speeds(crew, hs);
  const auto sweep_rest = [&](const SolverIsland& rest, JointPass pass) {
    sweep_joints(rest, hs, pass, sweeps_of(pass, rest.joint_sweeps));
  };
  with_rest([&](const SolverIsland& rest) { sweep_rest(rest, JointPass::moving); });
  solve_bundled_joints(crew, JointPass::moving);
  with_rest([&](const SolverIsland& rest) {
    sweep_rest(rest, JointPass::correcting);
    solve_rows(rest, hs, push_out, true);
  });
  solve_bundled_joints(crew, JointPass::correcting);
  each_colour(crew, [&](WideRange r) { wide_solve(rows_, r, step); });
  if (books_.open) add_taken(JointPass::moving);
  each_share(crew, {0, simple_ / uint32_t(wide_lanes)},
             [&](WideRange r) { wide_move(rows_, r, step.hs); });
  if (after > 0) kick(crew, after);
  sum_all_joints(crew, hs, JointPass::moving);
  const auto relax_rest = [&](const SolverIsland& rest) {
    sweep_rest(rest, JointPass::relaxing);
    solve_rows(rest, hs, push_out, false);
    sum_impulses(rest);
  };
  with_rest([&](const SolverIsland& rest) {
    integrate_positions(c, special(), hs);
    write_poses();
    read_poses();
    if (after > 0) integrate_velocities(c, special(), after);
    refresh_spinning_rows(c, rest);
    refresh_joints(c, rest, hs);
    if (!has_joints()) relax_rest(rest);
  });
  if (has_joints()) {
    each_chunk(crew, all_joints(), [&](WideRange r) { wide_refresh_joints(rows_, r, step); });
    if (books_.open) note_blow_speeds(1);
    with_rest([&](const SolverIsland& rest) { warm_start_joints(rest, hs, JointPass::relaxing); });
    warm_start_bundled_joints(crew, step, JointPass::relaxing);
    with_rest(relax_rest);
    solve_bundled_joints(crew, JointPass::relaxing);
    follow_limits(crew, hs);
  }
  each_colour(crew, [&](WideRange r) { wide_relax(rows_, r, step); });
  if (index + 1 == c.settings->substeps) follow_with_armatures(crew, hs);
  if (books_.open) add_taken(JointPass::relaxing);
}

/// As in solve_joints.
void WideIsland::follow_with_armatures(Crew& crew, double hs) {
  if (drives_.empty() || sort_ == WideSort::joints) return;
  for (Part& part : parts_) part.change = has_armature(rest_of(part)) ? 1 : 0;
  if (std::ranges::any_of(parts_, [](const Part& part) { return part.change > 0; }))
    solve_struck_joints(crew, hs, JointPass::relaxing, 0);
}

void WideIsland::bounce(const SolverContext& c, Crew& crew, double hs) {
  if (std::ranges::any_of(rows_.contacts, &WideContact::bounces)) {
    rows_.rebounds.assign(rows_.points.size(), {});
    rows_.blow_changes.assign(rows_.contacts.size(), {});
  }
  if (sort_ == WideSort::jointed_bouncing) return bounce_in_turn(c, crew, hs);
  with_rest([&](const SolverIsland& rest) { apply_restitution(c, rest); });
  bounce_bundles(crew);
}

void WideIsland::bounce_bundles(Crew& crew) {
  if (std::ranges::any_of(rows_.contacts, &WideContact::bounces))
    each_colour(crew, [&](WideRange r) { wide_bounce(rows_, r); });
}

SolveResiduals WideIsland::store(const SolverContext& c, Crew& crew, double hs) {
  SolveResiduals left;
  with_rest([&](const SolverIsland& rest) {
    left.contacts = store_rows(c, rest, hs);
    left.joints = store_joints(c, rest, hs);
  });
  joint_residuals_.assign(all_joints().end / chunk_size + 1, 0);
  each_chunk(crew, all_joints(), [&](WideRange r) {
    joint_residuals_[r.begin / chunk_size] = wide_joint_residual(rows_, r);
    joint_bundles_.store(c, r, hs, rows_);
  });
  residuals_.assign(bundles_.size() / chunk_size + 1, 0);
  each_chunk(crew, all_bundles(), [&](WideRange r) {
    residuals_[r.begin / chunk_size] = wide_residual(rows_, r);
    store_contacts(c, r, hs);
  });
  each_block(crew, simple_, [&](uint32_t begin, uint32_t end) { store_bodies(c, begin, end); });
  tumble::store_bodies(c, special());
  for (const float r : residuals_) left.contacts = std::max(left.contacts, double(r));
  for (const float r : joint_residuals_) left.joints = std::max(left.joints, double(r));
  return left;
}

}  // namespace tumble
