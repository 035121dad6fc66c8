// Which islands a blow still goes through; the turns themselves: bounce_in_turn in wide_island.cpp.
#include "engine/dynamics/realtime/tolerances.hpp"
#include "engine/dynamics/realtime/wide/wide_island.hpp"

#include <algorithm>

namespace tumble {

/// Adds what the bundles changed in the last turn to the parts. Whether anything changed at all.
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

/// Where the last turn changed little the blow is over: these points bounce no more.
void WideIsland::settle_blows() {
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

void WideIsland::mark_struck(WideRange joints) {
  for (uint32_t i = joints.begin; i < joints.end; ++i) {
    WideJoint& j = rows_.joints[i];
    j.any_struck = false;
    for (uint32_t lane = 0; lane < wide_lanes; ++lane) {
      const bool struck = lane < j.lanes && parts_[part_of(j.a[lane], j.b[lane])].change > 0;
      j.struck[lane] = struck ? 1 : 0;
      j.any_struck = j.any_struck || struck;
    }
  }
}

}  // namespace tumble
