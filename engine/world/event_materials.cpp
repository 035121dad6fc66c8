#include "engine/world/event_materials.hpp"

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

}  // namespace tumble
