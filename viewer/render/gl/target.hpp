#pragma once
#include "viewer/render/device_ledger.hpp"
#include "viewer/render/gl/functions.hpp"

namespace tumble {

/// Makes textures, renderbuffers and framebuffer of a target and stores their names in the records.
/// Fails when the driver calls the framebuffer incomplete; release_gl_target frees what was made.
Status make_gl_target(const GlFunctions& gl, DeviceLedger& ledger, TargetId id, int max_samples);
void release_gl_target(const GlFunctions& gl, DeviceLedger& ledger, TargetId id);

}  // namespace tumble
