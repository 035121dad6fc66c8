#include "engine/dynamics/forces/net_pattern.hpp"

#include <algorithm>

namespace tumble {

NetParts parts_of(const NetPattern& pattern, const SpringNet::Tie& tie) {
  NetParts out;
  out.add(pattern, tie.a, -1);
  out.add(pattern, tie.b, 1);
  return out;
}

NetParts parts_of(const NetPattern& pattern, const SpringNet::Stencil& stencil) {
  NetParts out;
  for (uint32_t i = 0; i < stencil.count; ++i) out.add(pattern, stencil.end[i], stencil.weight[i]);
  return out;
}

void NetPattern::number(const SpringNet& net) {
  of_node.resize(net.nodes.size());
  blocks = 0;
  for (size_t i = 0; i < net.nodes.size(); ++i) {
    of_node[i].moves = blocks++;
    of_node[i].turns = net.nodes[i].turns ? blocks++ : none;
  }
}

void NetPattern::find(const SpringNet& net) {
  key_.clear();
  key_.push_back(blocks);
  for (const Blocks& b : of_node) key_.push_back(b.turns);
  for (const SpringNet::Tie& tie : net.ties) key_.insert(key_.end(), {tie.a.node, tie.b.node});
  for (const SpringNet::Stencil& s : net.stencils) {
    key_.push_back(s.count);
    for (uint32_t i = 0; i < s.count; ++i) key_.push_back(s.end[i].node);
  }
  if (key_ == known_) return;
  known_ = key_;
  std::vector<uint64_t> pairs;
  const auto collect = [&pairs](const NetParts& parts) {
    for (uint32_t i = 0; i < parts.count; ++i)
      for (uint32_t j = 0; j < parts.count; ++j)
        if (i != j) pairs.push_back(uint64_t{parts.at[i].block} << 32 | parts.at[j].block);
  };
  for (const SpringNet::Tie& tie : net.ties) collect(parts_of(*this, tie));
  for (const SpringNet::Stencil& s : net.stencils) collect(parts_of(*this, s));
  std::vector<uint64_t> sorted = pairs;
  std::ranges::sort(sorted);
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  row_start.assign(blocks + 1, 0);
  columns.clear();
  for (const uint64_t pair : sorted) {
    ++row_start[size_t(pair >> 32) + 1];
    columns.push_back(uint32_t(pair));
  }
  for (size_t i = 0; i < blocks; ++i) row_start[i + 1] += row_start[i];
  places.clear();
  for (const uint64_t pair : pairs)
    places.push_back(uint32_t(std::ranges::lower_bound(sorted, pair) - sorted.begin()));
}

}  // namespace tumble
