#pragma once
#include "engine/collision/continuous/moving_pair.hpp"

namespace tumble {

/// The method "conservative_advancement", for every pair. With meshes the interval is divided so
/// that within a part neither shape moves much farther than its own size; the triangles whose swept
/// bounds meet in a part are advanced one by one, each only up to the earliest contact so far.
TimeOfContact find_by_advancement(const MovingPair& pair);

}  // namespace tumble
