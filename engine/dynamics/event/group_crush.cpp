// Errors of an event group where no impulses exist: which bodies are crushed between which.
#include "engine/core/stop.hpp"
#include "engine/dynamics/event/group_state.hpp"
#include "engine/dynamics/event/impulses/crush.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

namespace tumble {
namespace {

std::string names_of(const EventContext& context, std::span<const uint32_t> slots) {
  std::string out;
  for (size_t i = 0; i < std::min(slots.size(), tolerances::most_crushed_names); ++i) {
    const bool last = i + 1 == slots.size();
    out += (i == 0 ? "" : last ? " and " : ", ") + context.name(slots[i]);
  }
  if (slots.size() > tolerances::most_crushed_names)
    out += fmt::format(" and {} more", slots.size() - tolerances::most_crushed_names);
  return out;
}

/// The error that names the crushed bodies, if it is proved that no impulses exist at these
/// contacts.
std::optional<Error> crush_of(GroupState& state, std::span<const size_t> which) {
  std::vector<ImpactPoint> points;
  for (const size_t i : which)
    points.push_back(
        state.impact_point(state.contacts[i], push_gap(state.contacts[i], state.bodies)));
  const std::optional<Crush> crush = find_crush(state.blocks(), points, state.joints_now());
  if (!crush) return {};
  std::set<uint32_t> crushed, pressing;
  double pressed = 0;
  for (size_t k = 0; k < which.size(); ++k) {
    if (crush->shares[k] < tolerances::part_of_crush) continue;
    for (const uint32_t slot :
         {state.contacts[which[k]].key.body_a, state.contacts[which[k]].key.body_b}) {
      if (state.bodies[slot].dynamic()) {
        crushed.insert(slot);
      } else {
        pressing.insert(slot);
        pressed += crush->shares[k];
      }
    }
  }
  const std::vector<uint32_t> who(crushed.begin(), crushed.end()),
      by(pressing.begin(), pressing.end());
  const double speed = (by.size() > 1 ? 2 : 1) * crush->speed / pressed;
  const char* const what = crush->by_friction ? "jammed" : "crushed";
  const char* const how = by.size() > 1 ? "which close in on it" : "which closes in on it";
  const char* const why =
      crush->by_friction ? "friction lets nothing slip out" : "nothing rigid can bear that";
  const char* const cure = crush->by_friction ? "use less friction, or " : "leave more room, ";
  return Error{
      ErrorCode::numeric,
      fmt::format("{} between {}, {} at {:.3g} m/s: {}", what, names_of(state.context, by), how,
                  speed, why),
      names_of(state.context, who),
      fmt::format("{}stop the kinematic body in time, or let a spring drive a dynamic one", cure)};
}

}  // namespace

Error GroupState::lost(std::string what, std::string cure) {
  if (stop_requested()) return stopped_error();
  std::vector<size_t> near;
  for (size_t i = 0; i < contacts.size(); ++i) {
    const ElementGap g = push_gap(contacts[i], bodies);
    const double closing = std::max(0.0, -g.rate) * part.tick;
    if (g.regular && contacts[i].room(g) <= tolerances::closed_distance + closing)
      near.push_back(i);
  }
  if (std::optional<Error> crush = crush_of(*this, near)) {
    group.crushed = true;
    return std::move(*crush);
  }
  return error(std::move(what), std::move(cure));
}

}  // namespace tumble
