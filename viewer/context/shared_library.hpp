#pragma once
#include "engine/core/result.hpp"

#include <string>

namespace tumble {

/// A library loaded at run time with local symbols, so that two implementations of OpenGL can
/// coexist in one process. Never closed, because drivers leave threads and exit handlers behind.
class SharedLibrary {
 public:
  /// `cure` is part of the error if the library cannot be loaded.
  static Result<SharedLibrary> open(const char* file, const char* cure);

  /// Sets `function` to the library's symbol of that name; false if there is none.
  template <class F>
  bool find(const char* name, F*& function) const {
    function = reinterpret_cast<F*>(symbol(name));
    return function != nullptr;
  }

 private:
  explicit SharedLibrary(void* handle) : handle_(handle) {}
  void* symbol(const char* name) const;
  void* handle_;
};

}  // namespace tumble
