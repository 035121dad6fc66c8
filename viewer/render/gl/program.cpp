#include "viewer/render/gl/program.hpp"

#include <utility>

namespace tumble {
namespace {

Result<GLuint> compile(const GlFunctions& gl, GLenum kind, const std::string& source,
                       const std::string& place) {
  const GLuint shader = gl.CreateShader(kind);
  const char* text = source.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint good = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  std::string log(4096, '\0');
  GLsizei length = 0;
  gl.GetShaderInfoLog(shader, GLsizei(log.size()), &length, log.data());
  log.resize(size_t(length));
  gl.DeleteShader(shader);
  return Error{ErrorCode::parse, "shader does not compile: " + log, place, ""};
}

GLenum gl_type(AttributeType t) {
  return t == AttributeType::f32   ? GL_FLOAT
         : t == AttributeType::u32 ? GL_UNSIGNED_INT
                                   : GL_UNSIGNED_BYTE;
}

struct BlendFactors {
  GLenum drawn, there;  ///< factors of the source (fragment) and destination (target) colours
  GLenum there_alpha = GL_ONE_MINUS_SRC_ALPHA;  ///< factor of the target's alpha (transmittance);
                                                ///< the fragment adds none
};
BlendFactors blend_factors(const PipelineDesc& desc) {
  switch (desc.blend) {
    case Blend::alpha:
      return {GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA};
    case Blend::add:
      return {GL_ONE, GL_ONE, GL_ONE};
    case Blend::multiply:
      return {GL_ZERO, GL_SRC_COLOR, GL_ONE};
    case Blend::under:
      return {GL_DST_ALPHA, GL_ONE, GL_ZERO};
    case Blend::premultiplied:
      return {GL_ONE, GL_ONE_MINUS_SRC_ALPHA};
    case Blend::none:
      break;
  }
  return {GL_ONE, GL_ZERO, GL_ZERO};
}

void enable(const GlFunctions& gl, GLenum what, bool on) {
  on ? gl.Enable(what) : gl.Disable(what);
}

}  // namespace

GlPrograms::~GlPrograms() {
  for (const auto& [name, program] : programs_) gl_.DeleteProgram(name);
  for (const auto& [source, name] : shaders_) gl_.DeleteShader(name);
}

Result<GLuint> GlPrograms::shader(GLenum kind, const std::string& source,
                                  const std::string& place) {
  const auto known = shaders_.find({kind, source});
  if (known != shaders_.end()) return known->second;
  auto made = compile(gl_, kind, source, place);
  if (made) shaders_[{kind, source}] = *made;
  return made;
}

unsigned GlPrograms::add(const PipelineDesc& desc) {
  for (auto& [name, program] : programs_) {
    if (program.vertex_source != desc.vertex_source ||
        program.fragment_source != desc.fragment_source || program.textures != desc.textures ||
        program.uniform_blocks != desc.uniform_blocks)
      continue;
    ++program.users;
    return name;
  }
  const GLuint name = gl_.CreateProgram();
  programs_[name] = {desc.name,     desc.vertex_source,  desc.fragment_source,
                     desc.textures, desc.uniform_blocks, 1};
  return name;
}

Status GlPrograms::build(unsigned name, const Program& program) {
  auto vertex = shader(GL_VERTEX_SHADER, program.vertex_source, program.name + " (vertex)");
  if (!vertex) return vertex.error();
  auto fragment = shader(GL_FRAGMENT_SHADER, program.fragment_source, program.name + " (fragment)");
  if (!fragment) return fragment.error();
  gl_.AttachShader(name, *vertex);
  gl_.AttachShader(name, *fragment);
  gl_.LinkProgram(name);
  GLint good = 0;
  gl_.GetProgramiv(name, GL_LINK_STATUS, &good);
  if (good) return {};
  std::string log(4096, '\0');
  GLsizei length = 0;
  gl_.GetProgramInfoLog(name, GLsizei(log.size()), &length, log.data());
  log.resize(size_t(length));
  return Error{ErrorCode::parse, "shaders do not link: " + log, program.name,
               "update the driver, or try another --context"};
}

Status GlPrograms::link(unsigned name) {
  Program& program = programs_.at(name);
  if (program.linked) return *program.linked;
  program.linked = build(name, program);
  if (!*program.linked) return *program.linked;
  gl_.UseProgram(name);
  for (size_t i = 0; i < program.textures.size(); ++i)
    gl_.Uniform1i(gl_.GetUniformLocation(name, program.textures[i].c_str()), GLint(i));
  for (size_t i = 0; i < program.uniform_blocks.size(); ++i) {
    const GLuint block = gl_.GetUniformBlockIndex(name, program.uniform_blocks[i].c_str());
    if (block != GL_INVALID_INDEX) gl_.UniformBlockBinding(name, block, GLuint(i));
  }
  return {};
}

void GlPrograms::release(unsigned name) {
  const auto it = programs_.find(name);
  if (it == programs_.end() || --it->second.users > 0) return;
  gl_.DeleteProgram(name);
  programs_.erase(it);
}

void apply_gl_pipeline(const GlFunctions& gl, const PipelineDesc& desc, unsigned program) {
  gl.UseProgram(program);
  // With alpha to coverage, the alpha decides which samples are covered; what those store is
  // transmittance 0, not that alpha.
  const bool blends = desc.blend != Blend::none || desc.alpha_to_coverage;
  enable(gl, GL_BLEND, blends);
  if (blends) {
    const BlendFactors f = blend_factors(desc);
    gl.BlendFuncSeparate(f.drawn, f.there, GL_ZERO, f.there_alpha);
  }
  // Without the test GL does not write depth either.
  const bool depth = desc.depth_test != DepthTest::none || desc.depth_write;
  enable(gl, GL_DEPTH_TEST, depth);
  gl.DepthMask(desc.depth_write ? GL_TRUE : GL_FALSE);
  gl.DepthFunc(desc.depth_test == DepthTest::none      ? GL_ALWAYS
               : desc.depth_test == DepthTest::greater ? GL_GREATER
                                                       : GL_LEQUAL);
  enable(gl, GL_CULL_FACE, desc.cull != Cull::none);
  if (desc.cull != Cull::none) gl.CullFace(desc.cull == Cull::back ? GL_BACK : GL_FRONT);
  const GLboolean colour = desc.colour_write ? GL_TRUE : GL_FALSE;
  gl.ColorMask(colour, colour, colour, colour);
  enable(gl, GL_SAMPLE_ALPHA_TO_COVERAGE, desc.alpha_to_coverage);
  const bool bias = desc.depth_bias != 0 || desc.depth_slope_bias != 0;
  enable(gl, GL_POLYGON_OFFSET_FILL, bias);
  if (bias) gl.PolygonOffset(desc.depth_slope_bias, desc.depth_bias);
}

void apply_gl_attributes(const GlFunctions& gl, const PipelineDesc& desc, int slot,
                         size_t byte_offset) {
  for (const Attribute& a : desc.attributes) {
    if (a.slot != slot) continue;
    const void* at = reinterpret_cast<const void*>(byte_offset + a.offset);
    const GLsizei stride = desc.stride[size_t(slot)];
    gl.EnableVertexAttribArray(a.location);
    if (a.type == AttributeType::u32)
      gl.VertexAttribIPointer(a.location, a.components, GL_UNSIGNED_INT, stride, at);
    else
      gl.VertexAttribPointer(a.location, a.components, gl_type(a.type),
                             a.type == AttributeType::u8_unorm ? GL_TRUE : GL_FALSE, stride, at);
    gl.VertexAttribDivisor(a.location, slot == 1 ? 1 : 0);
  }
}

void disable_gl_attributes(const GlFunctions& gl, const PipelineDesc& desc) {
  for (const Attribute& a : desc.attributes) gl.DisableVertexAttribArray(a.location);
}

}  // namespace tumble
