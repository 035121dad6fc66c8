#include "viewer/render/gl/target.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

void filter(const GlFunctions& gl, GLint mode) {
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, mode);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, mode);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
}

GLuint make_texture(const GlFunctions& gl, const TargetDesc& d, GLint internal, GLenum format,
                    GLenum type) {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  gl.TexImage2D(GL_TEXTURE_2D, 0, internal, d.width, d.height, 0, format, type, nullptr);
  return texture;
}

GLuint make_storage(const GlFunctions& gl, const TargetDesc& d, GLenum internal, int samples) {
  GLuint buffer = 0;
  gl.GenRenderbuffers(1, &buffer);
  gl.BindRenderbuffer(GL_RENDERBUFFER, buffer);
  gl.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, internal, d.width,
                                    d.height);
  return buffer;
}

struct ColourFormat {
  GLint internal;
  GLenum format, type;
};
ColourFormat format_of(ColourAttachment colour) {
  switch (colour) {
    case ColourAttachment::r8:
      return {GL_R8, GL_RED, GL_UNSIGNED_BYTE};
    case ColourAttachment::r32f:
      return {GL_R32F, GL_RED, GL_FLOAT};
    case ColourAttachment::rgba16f:
      return {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT};
    case ColourAttachment::rgba8:
    case ColourAttachment::none:
      break;
  }
  return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
}

/// Several samples, which a shader can read.
void attach_samples(const GlFunctions& gl, DeviceLedger::Target& t, GLenum internal) {
  gl.GenTextures(1, &t.colour_samples);
  gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, t.colour_samples);
  gl.TexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, t.samples, internal, t.desc.width,
                           t.desc.height, GL_TRUE);
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D_MULTISAMPLE,
                          t.colour_samples, 0);
}

void attach_colour(const GlFunctions& gl, DeviceLedger& ledger, DeviceLedger::Target& t,
                   bool samples_are_read) {
  const TargetDesc& d = t.desc;
  if (d.colour == ColourAttachment::none) {
    gl.DrawBuffer(GL_NONE);
    gl.ReadBuffer(GL_NONE);
    return;
  }
  const ColourFormat f = format_of(d.colour);
  if (!t.colour && samples_are_read && t.samples > 1)
    return attach_samples(gl, t, GLenum(f.internal));
  if (!t.colour) {
    t.colour_storage = make_storage(gl, d, GLenum(f.internal), t.samples);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                               t.colour_storage);
    return;
  }
  const GLuint texture = make_texture(gl, d, f.internal, f.format, f.type);
  filter(gl, d.colour == ColourAttachment::r32f ? GL_NEAREST : GL_LINEAR);
  ledger.find(t.colour)->native = texture;
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
}

void attach_depth(const GlFunctions& gl, DeviceLedger& ledger, DeviceLedger::Target& t) {
  const TargetDesc& d = t.desc;
  if (d.depth == DepthAttachment::none) return;
  if (d.depth == DepthAttachment::buffer) {
    t.depth_storage = make_storage(gl, d, GL_DEPTH_COMPONENT24, t.samples);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                               t.depth_storage);
    return;
  }
  const GLuint texture =
      make_texture(gl, d, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT);
  const bool shadow = d.depth == DepthAttachment::shadow_texture;
  filter(gl, shadow ? GL_LINEAR : GL_NEAREST);
  if (shadow) {
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  }
  ledger.find(t.depth)->native = texture;
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture, 0);
}

}  // namespace

Status make_gl_target(const GlFunctions& gl, DeviceLedger& ledger, TargetId id, int max_samples,
                      bool samples_are_read) {
  DeviceLedger::Target& t = *ledger.find(id);
  t.samples = std::min(t.desc.samples, max_samples);
  gl.GenFramebuffers(1, &t.native);
  gl.BindFramebuffer(GL_FRAMEBUFFER, t.native);
  attach_colour(gl, ledger, t, samples_are_read);
  attach_depth(gl, ledger, t);
  const GLenum state = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
  const GLenum error = gl.GetError();
  if (state == GL_FRAMEBUFFER_COMPLETE && error != GL_OUT_OF_MEMORY) return {};
  return Error{ErrorCode::unsupported,
               fmt::format("the driver makes no {} x {} target with {} samples (0x{:X}, 0x{:X})",
                           t.desc.width, t.desc.height, t.samples, state, error),
               "", "ask for a smaller picture"};
}

void release_gl_target(const GlFunctions& gl, DeviceLedger& ledger, TargetId id) {
  DeviceLedger::Target& t = *ledger.find(id);
  for (const TextureId texture : {t.colour, t.depth})
    if (const DeviceLedger::Texture* x = ledger.find(texture)) gl.DeleteTextures(1, &x->native);
  if (t.colour_samples) gl.DeleteTextures(1, &t.colour_samples);
  if (t.colour_storage) gl.DeleteRenderbuffers(1, &t.colour_storage);
  if (t.depth_storage) gl.DeleteRenderbuffers(1, &t.depth_storage);
  gl.DeleteFramebuffers(1, &t.native);
}

}  // namespace tumble
