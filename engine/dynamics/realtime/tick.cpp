#include "engine/dynamics/realtime/tick.hpp"

#include "engine/core/stop.hpp"
#include "engine/dynamics/bodies/proxies.hpp"
#include "engine/dynamics/islands/waking.hpp"
#include "engine/dynamics/realtime/tick_groups.hpp"
#include "engine/dynamics/realtime/tick_parts.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"

#include <algorithm>
#include <utility>

namespace tumble {
void TickReport::add_group(const TickReport& group) {
  contacts.pairs += group.contacts.pairs;
  contacts.carried += group.contacts.carried;
  contacts.max_penetration = std::max(contacts.max_penetration, group.contacts.max_penetration);
  solve.add(group.solve);
  continuous.fast += group.continuous.fast;
  continuous.tested += group.continuous.tested;
  continuous.stopped += group.continuous.stopped;
  continuous.carried += group.continuous.carried;
}

void TickReport::set_groups(const TickReport& sum, const ContactSet& all) {
  contacts = sum.contacts;
  contacts.contacts = all.size();
  contacts.points = all.resting_points();
  for (const Contact& c : all.contacts()) contacts.points += uint64_t(c.count);
  solve = sum.solve;
  continuous = sum.continuous;
}

Status RealtimeTick::find_pairs(double part) {
  const ScopedStage stage(profiler, "broad phase");
  update_proxies(bodies, roster, gravity, part, settings.speculative_margin, proxies, &crew);
  listener.bounds_known();
  broad_phase.use_threads(&crew);
  broad_phase.set_owners(proxies.owners);
  broad_phase.find_pairs(proxies.proxies, proxies.news, pairs);
  apart.apply(proxies, pairs);
  report.bounds_tested += broad_phase.stats().tested;
  report.pairs_found += broad_phase.stats().found;
  const auto crowd = find_crowd(proxies, pairs);
  if (!crowd) return {};
  report.crowded = crowd->slot;
  return crowd->error;
}

void RealtimeTick::find_contacts(double part, const RealtimeSettings& tuning) {
  const ScopedStage stage(profiler, "narrow phase");
  report.contacts = contacts.update(bodies, proxies, pairs, gravity, part,
                                    tuning.speculative_margin, crew, narrow_phase, hierarchy);
}

void RealtimeTick::group(double part) {
  const ScopedStage stage(profiler, "islands");
  build_islands(bodies, contacts, links, part, islands, &crew, &roster);
  roster.add(islands.woken);
}

Status RealtimeTick::solve(double part, const RealtimeSettings& tuning) {
  const ScopedStage stage(profiler, "solve");
  if (tuning.continuous) {
    continuous.remember(bodies, islands.involved, gravity, &crew, roster.everything());
    continuous.pass_through(apart);
  }
  const auto solved = solver.step(bodies, contacts, islands, gravity, part, tuning, crew, joints,
                                  couplings, passed, springs, courses);
  if (!solved) return solved.error();
  report.solve = *solved;
  return {};
}

void RealtimeTick::sweep(double part, const RealtimeSettings& tuning) {
  if (!tuning.continuous) return;
  {
    const ScopedStage stage(profiler, "continuous");
    report.continuous =
        continuous.apply(bodies, path_broad_phase, part, tuning, crew, continuous_methods);
  }
  // Otherwise nothing was moved.
  if (report.continuous.fast + report.continuous.carried > 0) listener.put_back(continuous);
  if (!continuous.woken().empty()) wake_beside_carried();
}

/// Sleepers that touch one that was carried away may have lost what they rested on.
void RealtimeTick::wake_beside_carried() {
  std::vector<uint32_t> woken(continuous.woken().begin(), continuous.woken().end());
  const auto carried = [this](uint32_t i) {
    return std::ranges::binary_search(continuous.woken(), i);
  };
  contacts.for_each([&](const Contact& c) {
    const uint32_t a = c.key.body_a, b = c.key.body_b;
    if (carried(a) == carried(b)) return;
    const uint32_t other = carried(a) ? b : a;
    if (!bodies[other].dynamic() || !bodies[other].asleep) return;
    wake(bodies[other]);
    woken.push_back(other);
  });
  std::ranges::sort(woken);
  roster.add(woken);
}

void RealtimeTick::sleep() {
  const ScopedStage stage(profiler, "sleep");
  update_sleeping(bodies, islands, gravity.norm(), h, settings, sleep_scratch, &crew);
}

/// The stages from contacts to new poses, over the tick or one part of it.
Status RealtimeTick::advance(double part, const RealtimeSettings& tuning) {
  find_contacts(part, tuning);
  if (stop_requested()) return stopped_error();
  springs = listener.contacts_known(part);
  group(part);
  listener.islands_known();
  if (const Status solved = solve(part, tuning); !solved) return solved;
  if (stop_requested()) return stopped_error();
  listener.solved(part);
  sweep(part, tuning);
  return {};
}

/// Gives bodies on courses their velocities of a moment of the tick: the mean over a time of which
/// it is the middle.
void RealtimeTick::set_courses(double t) {
  for (const CourseMotion& course : courses) {
    const BodyVelocity now = course.at(t);
    bodies[course.slot].v = now.v;
    bodies[course.slot].omega = now.omega;
  }
}

/// The whole tick of all movable bodies in equal parts. The pairs of the first part are known, but
/// where bodies on courses have another velocity in it than in the tick.
Status RealtimeTick::in_parts(int parts) {
  const RealtimeSettings tuning = part_settings(settings, parts);
  for (int part = 0; part < parts; ++part) {
    // Also where there is one part: its means are rounded as those after several, so that what
    // follows has the same bits whether or not other bodies needed parts.
    set_courses((part + 0.5) * (h / parts));
    // Those known were found with the means of the tick, which may be 0 where a course turns.
    if (part > 0 || (parts > 1 && !courses.empty()))
      if (const Status found = find_pairs(h / parts); !found) return found;
    if (stop_requested()) return stopped_error();
    passed = part * (h / parts);
    if (const Status done = advance(h / parts, tuning); !done) return done;
  }
  set_courses(0.5 * h);
  contacts.scale_impulses(parts, bodies);
  sleep();
  listener.slept();
  return {};
}

/// The tick of the bodies with this number of parts.
Status RealtimeTick::group_tick(TickParts& parts, int number) {
  const auto other = [&](const ContactKey& key) {
    const int a = parts.of(key.body_a), b = parts.of(key.body_b);
    const bool numbered =
        (bodies[key.body_a].dynamic() && a > 0) || (bodies[key.body_b].dynamic() && b > 0);
    return numbered && !(bodies[key.body_a].dynamic() && a == number) &&
           !(bodies[key.body_b].dynamic() && b == number);
  };
  const ContactKnowledge others = contacts.take_out(other);
  {
    HeldBodies held(bodies);
    held.hold_others(parts, number);
    if (const Status found = find_pairs(h); !found) return found;
    if (const Status done = in_parts(number); !done) return done;
  }
  contacts.put_in(others);
  parts.take_in(roster.active(), number);
  return {};
}

/// Runs one number of parts after the other, while bodies with another one stand still.
Status RealtimeTick::by_groups(TickParts& parts) {
  roster.forget();  // other bodies than those that move are changed
  KinematicPaths kinematic(bodies, roster.active());
  IslandSet all_islands;
  TickReport sum;
  for (const int number : parts.numbers()) {
    kinematic.start();
    if (const Status done = group_tick(parts, number); !done) return done;
    kinematic.keep(parts, number);
    all_islands.append(islands);
    sum.add_group(report);
  }
  kinematic.finish();
  std::swap(islands, all_islands);
  report.set_groups(sum, contacts);
  return {};
}

Status RealtimeTick::run() {
  solver.begin_tick();
  if (const Status found = find_pairs(h); !found) return found;
  TickParts parts;
  parts.find({bodies, roster.active(), proxies, pairs, links, contacts, h, close, gravity.norm()},
             settings);
  report.parts = parts.greatest();
  const bool alike = parts.numbers().size() == 1;
  if (const Status done = alike ? in_parts(report.parts) : by_groups(parts); !done) return done;
  listener.moved();
  return {};
}

}  // namespace tumble
