#pragma once
#include "engine/core/parameters.hpp"

#include <string>

namespace tumble {

/// The declaration with both ends of its range: where one is not declared it is the largest
/// magnitude that a number of that unit may have in a scene. Far beyond all that people simulate,
/// and so far from the largest double that no sum or product of a tick overflows.
Parameter bounded(Parameter p);
/// "must be in 0..1", "must be > 0 m": the range of a parameter as an instruction.
std::string range_text(const Parameter& p);
/// Why `value` is not acceptable, or empty when it is.
std::string range_fault(double value, const Parameter& p);

}  // namespace tumble
