#pragma once
#include "viewer/context/gl_context.hpp"

namespace tumble {

/// A target for EGL contexts: a device, or none (surfaceless platform).
struct EglPlace {
  std::string name;    ///< "egl:0", "surfaceless"
  std::string detail;  ///< device file, or name of the platform
};

/// All EGL devices in the driver's order. Fails if libEGL or the extension is missing, or no driver
/// is registered.
Result<std::vector<EglPlace>> egl_devices();

// Each makes a context of version 3.3 core or later, current on the calling thread.

Result<std::unique_ptr<GlContext>> make_egl_device_context(size_t device);
Result<std::unique_ptr<GlContext>> make_egl_surfaceless_context();
Result<std::unique_ptr<GlContext>> make_osmesa_context();

/// Fills renderer, vendor, version and `software` from the current context; fails for versions
/// below 3.3.
Status describe_current(const GlContext& context, ContextInfo& info);

}  // namespace tumble
