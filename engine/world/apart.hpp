#pragma once

namespace tumble {

class PairFilter;
struct WorldState;

/// All pairs that do not collide with each other while blocks are there: what joints tie together,
/// and the two ends of each link of a mesh, which would wedge each other apart where a cloth is
/// pressed together along its threads.
void find_apart(WorldState& state, PairFilter& out);

}  // namespace tumble
