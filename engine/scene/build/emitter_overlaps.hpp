#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Two emitters with overlapping regions that emit colliding particles or bodies at the same time.
struct EmitterOverlap {
  std::string first, second;  ///< their names, in alphabetical order
  Vec3 place = Vec3::Zero();  ///< of the second [m]
};

/// The overlaps of a scene at its start. Regions without a simple interior (rings, surfaces,
/// meshes) are left out, as are emitters on different carriers and those that only events trigger.
std::vector<EmitterOverlap> emitter_overlaps(const BuiltScene& built);

}  // namespace tumble
