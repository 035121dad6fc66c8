#pragma once
#include "engine/core/result.hpp"

#include <string>

namespace tumble {

/// A library opened at run time with its names kept to itself, so that two implementations of
/// OpenGL can live in one process. Never closed: drivers leave threads and exit handlers behind.
class SharedLibrary {
 public:
  /// `cure` goes into the error when the file cannot be opened.
  static Result<SharedLibrary> open(const char* file, const char* cure);

  /// Sets `function` to the library's symbol of that name; false when it has none.
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
