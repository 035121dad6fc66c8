#pragma once
#include "engine/core/parameters.hpp"
#include "engine/dynamics/event/event_settings.hpp"
#include "engine/dynamics/realtime/realtime_settings.hpp"
#include "engine/math/varying.hpp"
#include "engine/world/time.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Everything about a world that can be changed while it runs. Part of the state.
struct WorldSettings {
  TickRate tick;
  /// May follow a course. Between ticks it is what it is now, within one what it is in the middle
  /// of that [m/s2].
  VaryingVec3 gravity{0, -9.81, 0};
  std::string stepper = "realtime";                       ///< name in stepper_names()
  std::string broad_phase = "uniform_grid";               ///< name in all_broad_phases()
  std::string hierarchy = "aabb";                         ///< name in all_hierarchies()
  std::string narrow_phase = "gjk";                       ///< name in all_narrow_phases()
  std::string contact_time = "conservative_advancement";  ///< name in all_contact_time_methods()
  RealtimeSettings realtime;
  EventSettings event;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.tick, {.name = "tick_hz",
                     .unit = "Hz",
                     .min = 1,
                     .max = 100000,
                     .doc = "ticks per second, an integer or \"n/d\""});
    v.field(d.gravity, {.name = "gravity", .unit = "m/s2", .doc = "uniform gravity"});
    v.field(d.stepper, {.name = "stepper", .doc = "how a tick is computed"});
    v.field(d.broad_phase, {.name = "broad_phase", .doc = "how overlapping bounds are found"});
    v.field(d.hierarchy,
            {.name = "hierarchy", .doc = "how near triangles of two meshes are found"});
    v.field(d.narrow_phase,
            {.name = "narrow_phase", .doc = "how contacts of convex pairs are found"});
    v.field(d.contact_time,
            {.name = "contact_time", .doc = "how the first contact of fast bodies is found"});
    v.object(d.realtime, {.name = "realtime", .doc = "settings of the realtime stepper"});
    v.object(d.event, {.name = "event", .doc = "settings of the event stepper"});
  }
};

/// "event", "realtime".
std::vector<std::string_view> stepper_names();

}  // namespace tumble
