#pragma once
#include "viewer/render/device_ledger.hpp"
#include "viewer/render/gl/functions.hpp"

namespace tumble {

/// Makes textures, renderbuffers and framebuffer of a target and stores their names in the ledger's
/// records. Fails if the driver reports an incomplete framebuffer; release_gl_target then frees
/// what was made. `samples_are_read`: several samples are stored where shaders can read them.
Status make_gl_target(const GlFunctions& gl, DeviceLedger& ledger, TargetId id, int max_samples,
                      bool samples_are_read);
void release_gl_target(const GlFunctions& gl, DeviceLedger& ledger, TargetId id);

}  // namespace tumble
