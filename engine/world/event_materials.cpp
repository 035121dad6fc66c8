#include "engine/world/event_materials.hpp"

#include "engine/world/joint_drives.hpp"

#include <utility>

#include <fmt/format.h>

namespace tumble {

Status event_takes(const Material& material, const std::string& whose) {
  for (const auto& [name, arm] : {std::pair("rolling_friction", material.rolling_friction),
                                  std::pair("torsional_friction", material.torsional_friction)}) {
    if (arm > default_turning_friction)
      return Error{ErrorCode::unsupported,
                   fmt::format("{} = {} m is not known to the event stepper", name, arm), whose,
                   "leave it out, or take the stepper realtime"};
  }
  return {};
}

Status event_takes(const JointDef& joint) {
  const JointKindEntry& kind = entry_of(joint.kind);
  for (size_t k = 0; k < kind.coordinates.size(); ++k)
    if (const std::string_view what = not_smooth(joint.drives[k]); !what.empty())
      return Error{ErrorCode::unsupported,
                   fmt::format("the event stepper knows no {} along the {} of a joint", what,
                               kind.coordinates[k].name),
                   joint.name,
                   "take the stepper realtime; or use springs, dampers, limits with stiffness, and "
                   "motors of force or position"};
  return {};
}

}  // namespace tumble
