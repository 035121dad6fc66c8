#pragma once
#include "engine/core/memory_use.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Two nodes that a constraint couples. `fixed` stands for an immovable body: edges do not conflict
/// there.
struct ColourEdge {
  static constexpr uint32_t fixed = ~uint32_t{0};
  uint32_t a = fixed, b = fixed;
};

/// Edge colouring: no two edges of a colour share a node, so that all edges of a colour can be
/// solved at once and in any order. Greedy: each edge in turn takes the lowest colour that is free
/// at both ends, which needs at most one colour less than twice the greatest number of edges at a
/// node; edges for which no colour is left are set aside. Depends on its input only. Memory is
/// reused.
class Colouring {
 public:
  static constexpr uint32_t most = 32;  ///< number of colours

  /// Edges whose ends are both fixed go to the first colour.
  void assign(std::span<const ColourEdge> edges, uint32_t nodes);

  /// Number of colours in use, which are the lowest ones.
  uint32_t colours() const { return used_; }
  /// Indices of the edges of a colour, ascending.
  std::span<const uint32_t> of(uint32_t colour) const { return part(colour); }
  std::span<const uint32_t> left_over() const { return part(most); }
  size_t bytes() const { return heap_bytes(taken_, colour_, order_); }

 private:
  std::span<const uint32_t> part(uint32_t k) const {
    return std::span(order_).subspan(begin_[k], begin_[k + 1] - begin_[k]);
  }
  std::vector<uint32_t> taken_;  ///< by node: a bit for each colour of its edges
  std::vector<uint8_t> colour_;  ///< by edge; `most` if none was free
  std::vector<uint32_t> order_;  ///< edges sorted by colour
  std::array<uint32_t, most + 2> begin_{};
  uint32_t used_ = 0;
};

}  // namespace tumble
