#pragma once
#include "engine/math/lcp/pivoting/pivot_state.hpp"

namespace tumble::lcp {

/// A start for principal pivoting: clamps every unknown whose w has the wrong sign, then exchanges
/// all violated unknowns at once, as long as their number has decreased within the last three
/// rounds (Júdice & Pires 1994), and finally frees clamped unknowns until all are within bounds.
/// Unknowns whose rows depend on clamped ones are left out.
void block_start(PivotState& state);

/// Frees clamped unknowns that exceed their bounds by more than rounding, until there is none;
/// those within rounding are set to the bound. Then solves for z and w.
void restore_bounds(PivotState& state);

}  // namespace tumble::lcp
