#include "viewer/render/gl/average.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

/// Fills its target with the average of so many samples.
PipelineDesc average_desc(int samples) {
  PipelineDesc d;
  d.name = "average";
  d.vertex_source = R"(#version 330 core
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 0.0, 1.0);
}
)";
  std::string sum = "texelFetch(canvas, pixel, 0)";
  for (int i = 1; i < samples; ++i) sum += fmt::format(" + texelFetch(canvas, pixel, {})", i);
  d.fragment_source = fmt::format(R"(#version 330 core
uniform sampler2DMS canvas;
out vec4 colour;
void main() {{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  colour = ({}) * {};
}}
)",
                                  sum, 1.0 / samples);
  d.textures = {"canvas"};
  d.depth_test = DepthTest::none;
  d.depth_write = false;
  d.cull = Cull::none;
  return d;
}

}  // namespace

Status GlAverage::draw(unsigned samples_texture, int samples, std::span<const ScissorRect> parts) {
  const PipelineDesc desc = average_desc(samples);
  if (!by_samples_.contains(samples)) by_samples_[samples] = programs_.add(desc);
  const unsigned program = by_samples_[samples];
  if (Status linked = programs_.link(program); !linked) return linked;
  apply_gl_pipeline(gl_, desc, program);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, samples_texture);
  gl_.Enable(GL_SCISSOR_TEST);
  for (const ScissorRect& part : parts) {
    gl_.Scissor(part.x, part.y, part.width, part.height);
    gl_.DrawArraysInstanced(GL_TRIANGLES, 0, 3, 1);
  }
  return {};
}

}  // namespace tumble
