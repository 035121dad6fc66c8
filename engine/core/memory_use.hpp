#pragma once
#include <cstddef>
#include <vector>

namespace tumble {

/// Memory by purpose [bytes]; it grows and shrinks with the number of objects.
struct MemoryUse {
  size_t bodies = 0;
  size_t contacts = 0;  ///< including pairs that are near each other
  size_t joints = 0;
};

/// Heap memory of vectors [bytes], without what their elements own.
template <class... T>
size_t heap_bytes(const std::vector<T>&... all) {
  return (size_t{0} + ... + (all.capacity() * sizeof(T)));
}

}  // namespace tumble
