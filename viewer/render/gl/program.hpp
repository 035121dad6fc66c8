#pragma once
#include "viewer/render/device.hpp"
#include "viewer/render/gl/functions.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// The programs of a device. Pipelines of the same sources share one; it is linked when something
/// is first drawn with it, since linking is most of what a start costs and few scenes need them
/// all.
class GlPrograms {
 public:
  explicit GlPrograms(const GlFunctions& gl) : gl_(gl) {}
  ~GlPrograms();
  GlPrograms(const GlPrograms&) = delete;
  GlPrograms& operator=(const GlPrograms&) = delete;

  /// Compiles what is new. Fails with the driver's log. Returns the program's name.
  Result<unsigned> add(const PipelineDesc& desc);
  /// Links, and binds samplers to units and uniform blocks to points in the order of the
  /// description. Does nothing the second time but give back the failure, if it was one.
  Status link(unsigned program);
  /// Once for each add.
  void release(unsigned program);

 private:
  struct Program {
    std::string key, name;
    std::vector<std::string> textures, uniform_blocks;
    int users = 0;
    bool linked = false;
    std::optional<Error> failure{};  ///< of linking
  };
  Result<GLuint> shader(GLenum kind, const std::string& source, const std::string& place);

  const GlFunctions& gl_;
  std::map<std::pair<GLenum, std::string>, GLuint> shaders_;  ///< by kind and source
  std::map<unsigned, Program> programs_;                      ///< by name
};

/// Sets blending, depth, culling and write masks, and binds the program.
void apply_gl_pipeline(const GlFunctions& gl, const PipelineDesc& desc, unsigned program);

/// Points the attributes of one slot into the buffer that is bound to GL_ARRAY_BUFFER.
void apply_gl_attributes(const GlFunctions& gl, const PipelineDesc& desc, int slot,
                         size_t byte_offset);
void disable_gl_attributes(const GlFunctions& gl, const PipelineDesc& desc);

}  // namespace tumble
