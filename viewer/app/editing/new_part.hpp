#pragma once
#include "engine/scene/build/live_parts.hpp"
#include "viewer/ui/build_choice.hpp"

#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// Where something new is to be.
struct PartPlace {
  Vec3 at = Vec3::Zero(), normal = Vec3::UnitY();
  double size = 1;   ///< of new things at the distance it is looked at from [m]
  std::string body;  ///< that an emitter is to make copies of; "": particles
};

/// Descriptions of what a click adds, with names that nobody in `parts` has: one, or two where an
/// emitter brings the particle system that it fills. The last one is what was asked for.
std::vector<std::pair<std::string, PartDescription>> new_parts(PartKind kind,
                                                               const PartPlace& place,
                                                               const SceneDescription& parts);

}  // namespace tumble
