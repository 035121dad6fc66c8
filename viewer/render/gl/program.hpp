#pragma once
#include "viewer/render/device.hpp"
#include "viewer/render/gl/functions.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// The programs of a device. Pipelines of the same sources share one. A program is compiled and
/// linked at its first draw, because no picture needs all of them.
class GlPrograms {
 public:
  explicit GlPrograms(const GlFunctions& gl) : gl_(gl) {}
  ~GlPrograms();
  GlPrograms(const GlPrograms&) = delete;
  GlPrograms& operator=(const GlPrograms&) = delete;

  /// Returns the program's name (handle).
  unsigned add(const PipelineDesc& desc);
  /// Compiles shaders that are new, links, and binds samplers to units and uniform blocks to
  /// binding points in the order of the description. Fails with the driver's log. Later calls only
  /// return the outcome of the first.
  Status link(unsigned program);
  /// To be called once for each add().
  void release(unsigned program);

 private:
  struct Program {
    std::string name, vertex_source, fragment_source;
    std::vector<std::string> textures, uniform_blocks;
    int users = 0;
    std::optional<Status> linked{};  ///< empty: not tried yet
  };
  Status build(unsigned name, const Program& program);
  Result<GLuint> shader(GLenum kind, const std::string& source, const std::string& place);

  const GlFunctions& gl_;
  std::map<std::pair<GLenum, std::string>, GLuint> shaders_;  ///< by kind and source
  std::map<unsigned, Program> programs_;                      ///< by name
};

/// Sets blending, depth, culling and write masks, and binds the program.
void apply_gl_pipeline(const GlFunctions& gl, const PipelineDesc& desc, unsigned program);

/// Describes the attributes of one slot in the buffer that is bound to GL_ARRAY_BUFFER.
void apply_gl_attributes(const GlFunctions& gl, const PipelineDesc& desc, int slot,
                         size_t byte_offset);
void disable_gl_attributes(const GlFunctions& gl, const PipelineDesc& desc);

}  // namespace tumble
