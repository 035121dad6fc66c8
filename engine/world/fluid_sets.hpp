#pragma once
#include "engine/world/fluid_workspace.hpp"
#include "engine/world/state.hpp"

namespace tumble {

/// Slots of the particle systems whose fluids are solved together: all whose solver and kernel are
/// the same, and whose spacings are about the same. Each joins the first set that takes it.
std::vector<std::vector<uint32_t>> fluid_sets(const WorldState& state);

/// Particles of a set side by side, and back where they belong.
void gather_fluids(const WorldState& state, std::span<const uint32_t> set,
                   FluidWorkspace::Together& to);
void scatter_fluids(WorldState& state, std::span<const uint32_t> set,
                    std::span<const double> shares, const FluidWorkspace::Together& from);

}  // namespace tumble
