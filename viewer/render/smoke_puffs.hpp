#pragma once
#include <cstdint>
#include <vector>

namespace tumble {

/// Pictures of four puffs of smoke, two by two: RGB says which way the puff bulges there (right,
/// up, towards the eye; -1..1 as 0..255), A how dense it is. Made of noise, the same on every
/// machine.
struct PuffAtlas {
  int size = 0;  ///< [px] each way
  std::vector<uint32_t> texels;
};
PuffAtlas make_puff_atlas();

}  // namespace tumble
