#pragma once
#include <cstddef>

namespace tumble::test {

/// What the whole program takes from the heap while `f` runs, on any of its threads: calls of
/// malloc and its kin, which operator new and libraries come down to. Only in executables that
/// have allocations.cpp.
class AllocationCount {
 public:
  template <class F>
  static size_t during(const F& f) {
    begin();
    f();
    return end();
  }

 private:
  static void begin();
  static size_t end();
};

}  // namespace tumble::test
