#pragma once
#include "engine/dynamics/forces/force.hpp"

#include <optional>
#include <span>
#include <vector>

namespace tumble {

/// By body slot, blocks of particles included: a bound on the rates at which springs let it
/// oscillate or relax [1/s]. It is the greater of the square root of the body's row sum in M^-1 K
/// and of its row sum in M^-1 C, with the mobility of the body where the springs are attached. By
/// Gershgorin's theorem no mode of a net of springs is faster than the greatest of these, and an
/// explicit integrator with steps of a fraction of its inverse is stable. Links and bends of meshes
/// count as springs; other forces do not. Empty if there are no springs.
std::vector<double> spring_rates(std::span<const std::optional<ForceDef>> forces,
                                 const ForceContext& context);

}  // namespace tumble
