#pragma once
#include <cstddef>
#include <vector>

namespace tumble {

/// Resizes scratch memory, whose values may be lost: where it must grow it is not copied, and gets
/// twice what is needed, so that one that grows from tick to tick seldom does.
template <class T>
void resize_scratch(std::vector<T>& scratch, size_t size) {
  if (scratch.capacity() < size) {
    scratch.clear();
    scratch.reserve(2 * size);
  }
  scratch.resize(size);
}

}  // namespace tumble
