#pragma once
#include "engine/core/parameters.hpp"

#include <string>

namespace tumble {

/// The declaration with both ends of its range: an end that is not declared is the greatest
/// magnitude that a number of that unit may have in a scene. That is far beyond practical values,
/// and so far below the largest double that no sum or product in a tick overflows.
Parameter bounded(Parameter p);
/// "must be in 0..1", "must be > 0 m": the range of a parameter as an instruction.
std::string range_text(const Parameter& p);
/// Why `value` is not acceptable, or empty when it is.
std::string range_fault(double value, const Parameter& p);

}  // namespace tumble
