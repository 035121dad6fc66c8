#pragma once
#include "viewer/context/gl_context.hpp"

#include <GL/glcorearb.h>

namespace tumble {

// Every OpenGL function that is called. They are loaded through the context: a GL library linked
// into the program would belong to one kind of context and do nothing for the others.
#define TUMBLE_GL_FUNCTIONS(X)                                        \
  X(ActiveTexture, ACTIVETEXTURE)                                     \
  X(AttachShader, ATTACHSHADER)                                       \
  X(BindBuffer, BINDBUFFER)                                           \
  X(BindBufferRange, BINDBUFFERRANGE)                                 \
  X(BindFramebuffer, BINDFRAMEBUFFER)                                 \
  X(BindRenderbuffer, BINDRENDERBUFFER)                               \
  X(BindTexture, BINDTEXTURE)                                         \
  X(BindVertexArray, BINDVERTEXARRAY)                                 \
  X(BlendFuncSeparate, BLENDFUNCSEPARATE)                             \
  X(BlitFramebuffer, BLITFRAMEBUFFER)                                 \
  X(BufferData, BUFFERDATA)                                           \
  X(CheckFramebufferStatus, CHECKFRAMEBUFFERSTATUS)                   \
  X(Clear, CLEAR)                                                     \
  X(ClearColor, CLEARCOLOR)                                           \
  X(ColorMask, COLORMASK)                                             \
  X(CompileShader, COMPILESHADER)                                     \
  X(CreateProgram, CREATEPROGRAM)                                     \
  X(CreateShader, CREATESHADER)                                       \
  X(CullFace, CULLFACE)                                               \
  X(DeleteBuffers, DELETEBUFFERS)                                     \
  X(DeleteFramebuffers, DELETEFRAMEBUFFERS)                           \
  X(DeleteProgram, DELETEPROGRAM)                                     \
  X(DeleteRenderbuffers, DELETERENDERBUFFERS)                         \
  X(DeleteShader, DELETESHADER)                                       \
  X(DeleteTextures, DELETETEXTURES)                                   \
  X(DeleteVertexArrays, DELETEVERTEXARRAYS)                           \
  X(DepthFunc, DEPTHFUNC)                                             \
  X(DepthMask, DEPTHMASK)                                             \
  X(Disable, DISABLE)                                                 \
  X(DisableVertexAttribArray, DISABLEVERTEXATTRIBARRAY)               \
  X(DrawArraysInstanced, DRAWARRAYSINSTANCED)                         \
  X(DrawBuffer, DRAWBUFFER)                                           \
  X(DrawElementsInstancedBaseVertex, DRAWELEMENTSINSTANCEDBASEVERTEX) \
  X(Enable, ENABLE)                                                   \
  X(EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY)                 \
  X(FramebufferRenderbuffer, FRAMEBUFFERRENDERBUFFER)                 \
  X(FramebufferTexture2D, FRAMEBUFFERTEXTURE2D)                       \
  X(GenBuffers, GENBUFFERS)                                           \
  X(GenFramebuffers, GENFRAMEBUFFERS)                                 \
  X(GenRenderbuffers, GENRENDERBUFFERS)                               \
  X(GenTextures, GENTEXTURES)                                         \
  X(GenVertexArrays, GENVERTEXARRAYS)                                 \
  X(GetError, GETERROR)                                               \
  X(GetIntegerv, GETINTEGERV)                                         \
  X(GetProgramInfoLog, GETPROGRAMINFOLOG)                             \
  X(GetProgramiv, GETPROGRAMIV)                                       \
  X(GetShaderInfoLog, GETSHADERINFOLOG)                               \
  X(GetShaderiv, GETSHADERIV)                                         \
  X(GetUniformBlockIndex, GETUNIFORMBLOCKINDEX)                       \
  X(GetUniformLocation, GETUNIFORMLOCATION)                           \
  X(LinkProgram, LINKPROGRAM)                                         \
  X(PixelStorei, PIXELSTOREI)                                         \
  X(PolygonOffset, POLYGONOFFSET)                                     \
  X(ReadBuffer, READBUFFER)                                           \
  X(ReadPixels, READPIXELS)                                           \
  X(RenderbufferStorageMultisample, RENDERBUFFERSTORAGEMULTISAMPLE)   \
  X(Scissor, SCISSOR)                                                 \
  X(ShaderSource, SHADERSOURCE)                                       \
  X(TexImage2D, TEXIMAGE2D)                                           \
  X(TexImage2DMultisample, TEXIMAGE2DMULTISAMPLE)                     \
  X(TexParameteri, TEXPARAMETERI)                                     \
  X(Uniform1i, UNIFORM1I)                                             \
  X(UniformBlockBinding, UNIFORMBLOCKBINDING)                         \
  X(UseProgram, USEPROGRAM)                                           \
  X(VertexAttribDivisor, VERTEXATTRIBDIVISOR)                         \
  X(VertexAttribIPointer, VERTEXATTRIBIPOINTER)                       \
  X(VertexAttribPointer, VERTEXATTRIBPOINTER)                         \
  X(Viewport, VIEWPORT)

/// The functions of one context, without the prefix gl.
struct GlFunctions {
#define TUMBLE_GL_MEMBER(name, upper) PFNGL##upper##PROC name = nullptr;
  TUMBLE_GL_FUNCTIONS(TUMBLE_GL_MEMBER)
#undef TUMBLE_GL_MEMBER

  /// Fails naming the first function that the context lacks.
  static Result<GlFunctions> load(const GlContext& context);
};

}  // namespace tumble
