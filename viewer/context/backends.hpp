#pragma once
#include "viewer/context/gl_context.hpp"

namespace tumble {

/// One place where EGL can draw: a device, or no device at all (surfaceless).
struct EglPlace {
  std::string name;    ///< "egl:0", "surfaceless"
  std::string detail;  ///< device file, or what the platform is called
};

/// Every EGL device, in the driver's order; fails when libEGL or the extension is missing or no
/// driver is registered.
Result<std::vector<EglPlace>> egl_devices();

// Each gives a context that is current on the calling thread, of version 3.3 core or later.

Result<std::unique_ptr<GlContext>> make_egl_device_context(size_t device);
Result<std::unique_ptr<GlContext>> make_egl_surfaceless_context();
Result<std::unique_ptr<GlContext>> make_osmesa_context();

/// Fills renderer, vendor, version and `software` from the current context; fails below 3.3.
Status describe_current(const GlContext& context, ContextInfo& info);

}  // namespace tumble
