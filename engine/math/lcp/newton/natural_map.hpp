#pragma once
#include "engine/math/lcp/system/cone_system.hpp"

namespace tumble::lcp {

/// The natural map F(z, w) = z - P(z - w) of a unit, whose zeros are the solutions, after Alart &
/// Curnier (1991): P projects on the bounds; for a group it projects the laterals on the section of
/// the cone at the axial value max(0, z_a - w_a).
Triple natural_value(const ConeUnit& unit, const Triple& z, const Triple& w);

/// An element of its generalised Jacobian; `f` is not changed.
void set_natural_slope(const ConeUnit& unit, const Triple& z, const Triple& w, UnitValue& out);

}  // namespace tumble::lcp
