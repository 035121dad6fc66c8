#include "viewer/context/shared_library.hpp"

#include <dlfcn.h>

namespace tumble {

Result<SharedLibrary> SharedLibrary::open(const char* file, const char* cure) {
  void* handle = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (!handle) {
    const char* why = dlerror();
    return Error{ErrorCode::unsupported, why ? why : "cannot be opened", file, cure};
  }
  return SharedLibrary(handle);
}

void* SharedLibrary::symbol(const char* name) const {
  return dlsym(handle_, name);
}

}  // namespace tumble
