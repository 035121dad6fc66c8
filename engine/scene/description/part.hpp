#pragma once
#include "engine/scene/description/emitter.hpp"
#include "engine/scene/description/force.hpp"
#include "engine/scene/description/particles.hpp"
#include "engine/scene/description/sensor.hpp"

#include <string_view>
#include <variant>

namespace tumble {

/// What a scene holds besides bodies and joints, as it describes it: it can be added to a world
/// that runs, changed and taken away.
using PartDescription = std::variant<EmitterDescription, SensorDescription, ForceDescription,
                                     ParticleSystemDescription>;

/// Under which key of a scene the part stands.
inline std::string_view list_of(const PartDescription& part) {
  constexpr std::string_view lists[] = {"emitters", "sensors", "forces", "particles"};
  return lists[part.index()];
}

}  // namespace tumble
