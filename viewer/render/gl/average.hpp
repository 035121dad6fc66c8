#pragma once
#include "viewer/render/gl/program.hpp"

#include <map>

namespace tumble {

/// Averages the samples of a target by a shader. To software renderers this is what
/// glBlitFramebuffer does, except that Mesa compiles the shaders of its own blits anew in every
/// process, whereas those of programs come from its cache.
class GlAverage {
 public:
  GlAverage(const GlFunctions& gl, GlPrograms& programs) : gl_(gl), programs_(programs) {}

  /// Draws the average of `samples` into the parts (pixels from the bottom left) of the framebuffer
  /// that is bound, which has the same size. Leaves the scissor test on.
  Status draw(unsigned samples_texture, int samples, std::span<const ScissorRect> parts);

 private:
  const GlFunctions& gl_;
  GlPrograms& programs_;
  std::map<int, unsigned> by_samples_;  ///< programs
};

}  // namespace tumble
