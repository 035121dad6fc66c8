#include "engine/dynamics/realtime/tick.hpp"

#include "engine/core/stop.hpp"
#include "engine/dynamics/bodies/proxies.hpp"
#include "engine/dynamics/realtime/tick_parts.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {

namespace {

/// Pairs of near shapes that any tick may have, and how many more for each shape. Balls of one size
/// have 6 each where they are packed, and things of mixed sizes some dozens; a pair takes about a
/// kilobyte with its contact, what the contact was before, and the rows of the solver.
constexpr size_t pairs_at_least = 250'000, pairs_per_shape = 64;

/// Slot of the body that is in most of the pairs.
uint32_t most_crowded(const ProxySet& proxies, std::span<const ProxyPair> pairs) {
  std::vector<uint32_t> count(proxies.first.size());
  for (const ProxyPair& p : pairs)
    for (const uint32_t shape : {p.a, p.b}) ++count[proxies.refs[shape].body];
  return uint32_t(std::ranges::max_element(count) - count.begin());
}

}  // namespace

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
  if (pairs.size() <= pairs_at_least + pairs_per_shape * proxies.proxies.size()) return {};
  report.crowded = most_crowded(proxies, pairs);
  return Error{ErrorCode::numeric,
               fmt::format("{} shapes lie so densely that {} pairs of them are near each other, "
                           "more than a tick can hold",
                           proxies.proxies.size(), pairs.size()),
               {},
               "place them apart"};
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
  const auto solved = solver.step(bodies, contacts, islands, gravity, part, tuning, crew, joints);
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
  if (report.continuous.fast > 0) listener.put_back();  // else nothing was moved
}

void RealtimeTick::sleep() {
  const ScopedStage stage(profiler, "sleep");
  update_sleeping(bodies, islands, gravity.norm(), h, settings, sleep_scratch, &crew);
}

/// From the pairs to new poses, over the tick or one part of it.
Status RealtimeTick::advance(double part, const RealtimeSettings& tuning) {
  find_contacts(part, tuning);
  if (stop_requested()) return stopped_error();
  group(part);
  listener.islands_known();
  if (const Status solved = solve(part, tuning); !solved) return solved;
  if (stop_requested()) return stopped_error();
  listener.solved(part);
  sweep(part, tuning);
  return {};
}

Status RealtimeTick::run() {
  if (const Status found = find_pairs(h); !found) return found;
  const int parts = report.parts = tick_parts(bodies, proxies, pairs, h, settings);
  const RealtimeSettings tuning = part_settings(settings, parts);
  for (int part = 0; part < parts; ++part) {
    if (part > 0)
      if (const Status found = find_pairs(h / parts); !found) return found;
    if (stop_requested()) return stopped_error();
    if (const Status done = advance(h / parts, tuning); !done) return done;
  }
  contacts.scale_impulses(parts, bodies);
  listener.moved();
  sleep();
  return {};
}

}  // namespace tumble
