#pragma once
#include "engine/world/fluid_workspace.hpp"
#include "engine/world/state.hpp"

namespace tumble {

/// Groups the particle systems of fluids into sets that are solved together: all with the same
/// solver and kernel, and nearly the same spacing. Each system joins the first set that it fits.
/// Returns the slots.
std::vector<std::vector<uint32_t>> fluid_sets(const WorldState& state);

/// Copies the particles of a set into arrays in which one system follows another; and writes
/// positions, velocities, pressures and densities back. `shares`: density of each particle over its
/// rest density [-].
void gather_fluids(const WorldState& state, std::span<const uint32_t> set,
                   FluidWorkspace::Together& to);
void scatter_fluids(WorldState& state, std::span<const uint32_t> set,
                    std::span<const double> shares, const FluidWorkspace::Together& from);

}  // namespace tumble
