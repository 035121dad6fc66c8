#pragma once
#include "engine/math/lcp/pivoting/pivot_state.hpp"

namespace tumble::lcp {

/// A start for principal pivoting: clamps every unknown whose w is wrong, then exchanges all wrong
/// unknowns at once while their number falls, or has not failed to for three rounds (Júdice & Pires
/// 1994), and at last frees clamped unknowns until all are within bounds. Unknowns whose rows
/// depend on clamped ones are left out.
void block_start(PivotState& state);

/// Frees clamped unknowns that are beyond their bounds by more than rounding until there is none;
/// those within rounding are put back on the bound. z and w are solved for.
void restore_bounds(PivotState& state);

}  // namespace tumble::lcp
