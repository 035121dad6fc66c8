#pragma once
#include "viewer/context/gl_context.hpp"
#include "viewer/render/device.hpp"

namespace tumble {

/// OpenGL 3.3 core through a context's own functions. The context must be current on this thread
/// and outlive the device. Fails when the version is lower or a function is missing.
Result<std::unique_ptr<Device>> make_gl_device(GlContext& context);

}  // namespace tumble
