#include "engine/dynamics/realtime/wide/colouring.hpp"

#include <algorithm>
#include <bit>

namespace tumble {

void Colouring::assign(std::span<const ColourEdge> edges, uint32_t nodes) {
  taken_.assign(nodes, 0);
  colour_.resize(edges.size());
  begin_.fill(0);
  used_ = 0;
  for (size_t i = 0; i < edges.size(); ++i) {
    const ColourEdge& e = edges[i];
    uint32_t taken = 0;
    if (e.a != ColourEdge::fixed) taken |= taken_[e.a];
    if (e.b != ColourEdge::fixed) taken |= taken_[e.b];
    const auto colour = uint32_t(std::countr_one(taken));  // 32 if all are taken
    colour_[i] = uint8_t(colour);
    ++begin_[colour + 1];
    if (colour == most) continue;
    used_ = std::max(used_, colour + 1);
    const uint32_t bit = uint32_t{1} << colour;
    if (e.a != ColourEdge::fixed) taken_[e.a] |= bit;
    if (e.b != ColourEdge::fixed) taken_[e.b] |= bit;
  }
  for (size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  order_.resize(edges.size());
  std::array<uint32_t, most + 2> next = begin_;
  for (uint32_t i = 0; i < edges.size(); ++i) order_[next[colour_[i]]++] = i;
}

}  // namespace tumble
