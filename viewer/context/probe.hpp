#pragma once
#include "viewer/context/doctor.hpp"

#include <string>

namespace tumble {

/// Makes the context of this name in this process, draws into a framebuffer of our own, and checks
/// the pixels. A crash or hang of the driver happens in this process.
DoctorEntry probe_context(const std::string& name);

}  // namespace tumble
