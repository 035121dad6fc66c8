#pragma once
#include "engine/scene/description/emitter.hpp"
#include "engine/scene/description/force.hpp"
#include "engine/scene/description/particles.hpp"
#include "engine/scene/description/sensor.hpp"

#include <string_view>
#include <variant>

namespace tumble {

/// Descriptions of the parts of a scene other than bodies and joints. They can be added to a
/// running world, changed and removed.
using PartDescription = std::variant<EmitterDescription, SensorDescription, ForceDescription,
                                     ParticleSystemDescription>;

/// The key of the scene's list that contains parts of this kind.
inline std::string_view list_of(const PartDescription& part) {
  constexpr std::string_view lists[] = {"emitters", "sensors", "forces", "particles"};
  return lists[part.index()];
}

}  // namespace tumble
