#pragma once

namespace tumble {

class PairFilter;
struct WorldState;

/// Collects the pairs of bodies and particle blocks that do not collide with each other in this
/// tick; to be called once the blocks are appended. These are pairs that joints exclude, and the
/// two ends of each link of a spring mesh where one of them is a particle: contacts between these
/// would push a cloth apart when it is compressed along its threads.
void find_apart(WorldState& state, PairFilter& out);

}  // namespace tumble
