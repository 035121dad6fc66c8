#include "viewer/context/backends.hpp"

#include <GL/glcorearb.h>

namespace tumble {
namespace {

std::string text_of(const GLubyte* s) {
  return s ? reinterpret_cast<const char*>(s) : "";
}

bool is_software(const std::string& renderer) {
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SWR", "Software", "SwiftShader"})
    if (renderer.find(name) != std::string::npos) return true;
  return false;
}

}  // namespace

Status describe_current(const GlContext& context, ContextInfo& info) {
  const auto get_string =
      reinterpret_cast<PFNGLGETSTRINGPROC>(context.get_proc_address("glGetString"));
  const auto get_integer =
      reinterpret_cast<PFNGLGETINTEGERVPROC>(context.get_proc_address("glGetIntegerv"));
  if (!get_string || !get_integer)
    return Error{ErrorCode::unsupported, "the driver gives no OpenGL functions", info.name,
                 "reinstall libgl1-mesa-dri"};
  info.renderer = text_of(get_string(GL_RENDERER));
  info.vendor = text_of(get_string(GL_VENDOR));
  info.version = text_of(get_string(GL_VERSION));
  info.software = is_software(info.renderer);
  GLint major = 0, minor = 0;
  get_integer(GL_MAJOR_VERSION, &major);
  get_integer(GL_MINOR_VERSION, &minor);
  if (info.version.empty() || major * 10 + minor < 33)
    return Error{ErrorCode::unsupported,
                 "OpenGL 3.3 is needed, got '" + info.version + "' of '" + info.renderer + "'",
                 info.name, "update the driver, or use --context osmesa"};
  return {};
}

}  // namespace tumble
