#pragma once
#include <cstddef>
#include <vector>

namespace tumble {

/// Memory by what it is for [bytes]; it grows and shrinks with their numbers.
struct MemoryUse {
  size_t bodies = 0;
  size_t contacts = 0;  ///< pairs that are near each other included
  size_t joints = 0;
};

/// What vectors take from the heap [bytes]; not what their elements take.
template <class... T>
size_t heap_bytes(const std::vector<T>&... all) {
  return (size_t{0} + ... + (all.capacity() * sizeof(T)));
}

}  // namespace tumble
