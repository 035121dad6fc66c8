#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Two emitters from which things that push each other come at the same time, of regions that
/// overlap.
struct EmitterOverlap {
  std::string first, second;  ///< their names, in alphabetical order
  Vec3 place = Vec3::Zero();  ///< of the second [m]
};

/// Of a scene at its start. Regions without a plain inside (rings, surfaces, meshes) are left out,
/// as are emitters on different carriers and those that only events call.
std::vector<EmitterOverlap> emitter_overlaps(const BuiltScene& built);

}  // namespace tumble
