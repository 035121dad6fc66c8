#pragma once
#include "engine/core/parameters.hpp"

#include <string>

namespace tumble {

/// "must be in 0..1", "must be > 0 m": the range of a parameter as an instruction.
std::string range_text(const Parameter& p);
/// Why `value` is not acceptable, or empty when it is.
std::string range_fault(double value, const Parameter& p);

}  // namespace tumble
