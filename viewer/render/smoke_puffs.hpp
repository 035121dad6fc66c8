#pragma once
#include <cstdint>
#include <vector>

namespace tumble {

/// Atlas of 2 x 2 puffs of smoke: RGB is a normal vector (right, up, towards the eye; -1..1 as
/// 0..255), A the density. Made of procedural noise, identical on every machine.
struct PuffAtlas {
  int size = 0;  ///< width and height [px]
  std::vector<uint32_t> texels;
};
PuffAtlas make_puff_atlas();

}  // namespace tumble
