#pragma once
#include "viewer/render/device.hpp"
#include "viewer/render/gl/functions.hpp"

namespace tumble {

/// Compiles and links; binds samplers to units and uniform blocks to points in the order of the
/// description. Fails with the driver's log. Returns the program's name.
Result<unsigned> make_gl_program(const GlFunctions& gl, const PipelineDesc& desc);

/// Sets blending, depth, culling and write masks, and binds the program.
void apply_gl_pipeline(const GlFunctions& gl, const PipelineDesc& desc, unsigned program);

/// Points the attributes of one slot into the buffer that is bound to GL_ARRAY_BUFFER.
void apply_gl_attributes(const GlFunctions& gl, const PipelineDesc& desc, int slot,
                         size_t byte_offset);
void disable_gl_attributes(const GlFunctions& gl, const PipelineDesc& desc);

}  // namespace tumble
