#include "viewer/app/session/microscope_pair.hpp"

#include "viewer/interact/picking.hpp"

#include <limits>

namespace tumble {
namespace {

/// Between two boxes; 0 where they overlap [m].
double gap_between(const Aabb& a, const Aabb& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).norm();
}

std::optional<MicroscopeSetup> find_alone(const Frame& frame, BodyId body) {
  for (const MicroscopeEntry& entry : all_microscopes()) {
    MicroscopeSetup setup;
    setup.algorithm = entry.name;
    setup.a = body;
    setup.span = 60 * frame.rate.tick();
    if (entry.of_world() && microscope_refusal(frame, setup).empty()) return setup;
  }
  return std::nullopt;
}

}  // namespace

std::optional<MicroscopeSetup> find_microscope_pair(const Frame& frame, BodyId body) {
  const auto own = find_slot(frame, body);
  if (!own) return find_alone(frame, BodyId{});
  const Aabb bounds = body_bounds(frame, *own);
  std::optional<MicroscopeSetup> best;
  double least = std::numeric_limits<double>::infinity();
  for (uint32_t slot = 0; slot < frame.body_slots(); ++slot) {
    if (frame.body(slot).id.is_null() || slot == *own) continue;
    const double gap = gap_between(bounds, body_bounds(frame, slot));
    if (!(gap < least)) continue;
    MicroscopeSetup setup;
    setup.a = body;
    setup.b = frame.body(slot).id;
    setup.span = 60 * frame.rate.tick();
    for (const MicroscopeEntry& entry : all_microscopes()) {
      setup.algorithm = entry.name;
      if (!entry.of_pair() || !microscope_refusal(frame, setup).empty()) continue;
      best = setup;
      least = gap;
      break;
    }
  }
  return best ? best : find_alone(frame, body);
}

}  // namespace tumble
