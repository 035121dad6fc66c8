#pragma once
#include "viewer/context/doctor.hpp"

#include <string>

namespace tumble {

/// Makes the context of this name in this process, draws a triangle through it into a framebuffer
/// of our own, and looks at the pixels. What a driver does wrong it does here.
DoctorEntry probe_context(const std::string& name);

}  // namespace tumble
