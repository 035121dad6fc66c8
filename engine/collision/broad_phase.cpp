#include "engine/collision/broad_phase.hpp"

#include "engine/collision/broad_phase/brute_force.hpp"
#include "engine/collision/broad_phase/uniform_grid.hpp"

namespace tumble {

const std::vector<BroadPhaseEntry>& all_broad_phases() {
  using Made = std::unique_ptr<BroadPhase>;
  static const std::vector<BroadPhaseEntry> list{
      {"brute_force", []() -> Made { return std::make_unique<BruteForceBroadPhase>(); }},
      {"uniform_grid", []() -> Made { return std::make_unique<UniformGridBroadPhase>(); }},
  };
  return list;
}

}  // namespace tumble
