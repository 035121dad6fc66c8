#pragma once
#include "engine/core/bytes.hpp"

#include <cstdint>
#include <vector>

namespace tumble {

/// Opaque reference to a slot: index and generation. Generation 0 is the null handle; a handle
/// whose slot was reused is detected by its generation and never dereferenced.
template <class Tag>
struct Handle {
  uint32_t index = 0;
  uint32_t generation = 0;

  bool is_null() const { return generation == 0; }
  explicit operator bool() const { return !is_null(); }
  /// Both halves in one word, generation high; unique over the life of a pool.
  uint64_t packed() const { return (uint64_t{generation} << 32) | index; }
  static Handle unpack(uint64_t p) { return {uint32_t(p & 0xffffffffu), uint32_t(p >> 32)}; }
  friend bool operator==(Handle, Handle) = default;
  /// Order by slot, then generation: the order in which everything is summed and solved.
  friend auto operator<=>(Handle a, Handle b) = default;
};

/// Allocates and frees handles, reusing the slot that was freed last; this order is part of the
/// state.
template <class Tag>
class HandlePool {
 public:
  Handle<Tag> allocate() {
    if (free_.empty()) {
      generations_.push_back(1);
      alive_.push_back(1);
      return {uint32_t(generations_.size() - 1), 1};
    }
    const uint32_t index = free_.back();
    free_.pop_back();
    alive_[index] = 1;
    return {index, generations_[index]};
  }

  /// Frees a live handle; for a stale one does nothing and returns false.
  bool release(Handle<Tag> h) {
    if (!contains(h)) return false;
    alive_[h.index] = 0;
    ++generations_[h.index];
    free_.push_back(h.index);
    return true;
  }

  bool contains(Handle<Tag> h) const {
    return h.generation != 0 && h.index < generations_.size() && alive_[h.index] &&
           generations_[h.index] == h.generation;
  }

  /// Number of slots ever used; live handles have an index below it.
  uint32_t capacity() const { return uint32_t(generations_.size()); }
  uint32_t count() const { return capacity() - uint32_t(free_.size()); }
  bool alive(uint32_t index) const { return index < alive_.size() && alive_[index] != 0; }
  Handle<Tag> at(uint32_t index) const { return {index, generations_[index]}; }

  void save(ByteWriter& out) const {
    out.vector(generations_);
    out.vector(alive_);
    out.vector(free_);
  }
  bool load(ByteReader& in) {
    in.vector(generations_);
    in.vector(alive_);
    in.vector(free_);
    return in.ok() && generations_.size() == alive_.size();
  }

 private:
  std::vector<uint32_t> generations_;
  std::vector<uint8_t> alive_;
  std::vector<uint32_t> free_;
};

}  // namespace tumble

template <class Tag>
struct std::hash<tumble::Handle<Tag>> {
  size_t operator()(tumble::Handle<Tag> h) const { return std::hash<uint64_t>{}(h.packed()); }
};
