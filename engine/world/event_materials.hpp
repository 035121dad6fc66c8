#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/body.hpp"

#include <string>

namespace tumble {

/// Whether the event stepper does what a material asks for. Rolling and torsional friction are
/// known to `realtime` only: they are refused, not ignored, with an error that names the body
/// `whose` they are, the value and the cure.
Status event_takes(const Material& material, const std::string& whose);

}  // namespace tumble
