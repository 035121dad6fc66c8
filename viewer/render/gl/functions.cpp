#include "viewer/render/gl/functions.hpp"

namespace tumble {

Result<GlFunctions> GlFunctions::load(const GlContext& context) {
  GlFunctions f;
  const std::string& backend = context.info().name;
#define TUMBLE_GL_LOAD(name, upper)                                                    \
  f.name = reinterpret_cast<PFNGL##upper##PROC>(context.get_proc_address("gl" #name)); \
  if (!f.name)                                                                         \
    return Error{ErrorCode::unsupported, "the driver lacks gl" #name, backend,         \
                 "OpenGL 3.3 core is needed; try --context osmesa"};
  TUMBLE_GL_FUNCTIONS(TUMBLE_GL_LOAD)
#undef TUMBLE_GL_LOAD
  return f;
}

}  // namespace tumble
