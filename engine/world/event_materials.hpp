#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/body.hpp"

#include <string>

namespace tumble {

/// Whether the event stepper does what a material asks for. It takes bodies as rigid: contacts in
/// points and lines have no width and resist no turning. Values up to the default, half a
/// millimetre, are therefore neglected; larger ones are refused, with an error that names the body
/// `whose` they are, the value and the cure.
Status event_takes(const Material& material, const std::string& whose);

}  // namespace tumble
