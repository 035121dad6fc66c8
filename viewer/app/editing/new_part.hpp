#pragma once
#include "engine/scene/build/live_parts.hpp"
#include "viewer/ui/build_choice.hpp"

#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// Where to add something new.
struct PartPlace {
  Vec3 at = Vec3::Zero(), normal = Vec3::UnitY();
  double size = 1;   ///< size of new things at this viewing distance [m]
  std::string body;  ///< template for the copies of an emitter; "": it emits particles
};

/// Descriptions of what a click adds, with names not used in `parts`: one, or two if an emitter
/// needs a particle system to fill. The last one is the part requested.
std::vector<std::pair<std::string, PartDescription>> new_parts(PartKind kind,
                                                               const PartPlace& place,
                                                               const SceneDescription& parts);

}  // namespace tumble
