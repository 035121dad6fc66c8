#include "engine/collision/broad_phase/packed_tree.hpp"

#include "engine/collision/broad_phase/draw_cells.hpp"
#include "engine/core/stop.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace tumble {
namespace {

/// Smaller trees are built faster by one thread.
constexpr size_t least_branching = 2048;

/// Largest number of members of a leaf: a few more comparisons are cheaper than one more level.
constexpr uint32_t leaf_size = 12;
/// Below this count comparisons sort faster than three passes over 1024 bins.
constexpr uint32_t radix_sort_from = 512;

/// Each is halved first, as the sum of two bounds could overflow.
Vec3 centre_of(const Aabb& b) {
  return 0.5 * b.min + 0.5 * b.max;
}

/// The lowest ten bits of x, two zeros between each.
uint32_t spread_bits(uint32_t x) {
  x = (x | (x << 16)) & 0x030000ffu;
  x = (x | (x << 8)) & 0x0300f00fu;
  x = (x | (x << 4)) & 0x030c30c3u;
  return (x | (x << 2)) & 0x09249249u;
}

/// Pairs of a member below node i of a and one below node j of b.
void pairs_between(const PackedTree& a, uint32_t i, const PackedTree& b, uint32_t j,
                   PairCollector& out) {
  const PackedTree::Node &x = a.nodes()[i], &y = b.nodes()[j];
  if (!may_overlap(x.bounds, y.bounds)) return;
  if (x.right == 0 && y.right == 0) {
    for (uint32_t k = x.first; k < x.last; ++k) {
      const PackedBounds& one = a.members().bounds[k];
      if (may_overlap(one, y.bounds))
        out.test(one, a.members().ids[k], b.members(), y.first, y.last);
    }
    return;
  }
  // Descend into the node with more members.
  if (y.right == 0 || (x.right != 0 && x.last - x.first >= y.last - y.first)) {
    pairs_between(a, i + 1, b, j, out);
    pairs_between(a, x.right, b, j, out);
  } else {
    pairs_between(a, i, b, j + 1, out);
    pairs_between(a, i, b, y.right, out);
  }
}

void pairs_below(const PackedTree& t, uint32_t i, PairCollector& out) {
  const PackedTree::Node& x = t.nodes()[i];
  if (x.right == 0) {
    for (uint32_t k = x.first; k < x.last; ++k)
      out.test(t.members().bounds[k], t.members().ids[k], t.members(), k + 1, x.last);
    return;
  }
  pairs_below(t, i + 1, out);
  pairs_below(t, x.right, out);
  pairs_between(t, i + 1, t, x.right, out);
}

/// Nodes to compare, of two trees, or of one tree with itself when they are equal.
struct NodePair {
  uint32_t i, j;
};

/// One step of the descent of pairs_below and pairs_between; pairs of two leaves are kept.
void step_down(const PackedTree& a, const PackedTree& b, NodePair p, std::vector<NodePair>& out) {
  const PackedTree::Node &x = a.nodes()[p.i], &y = b.nodes()[p.j];
  if (&x == &y) {
    if (x.right == 0) return out.push_back(p);
    out.insert(out.end(), {{p.i + 1, p.i + 1}, {x.right, x.right}, {p.i + 1, x.right}});
    return;
  }
  if (!may_overlap(x.bounds, y.bounds)) return;
  if (x.right == 0 && y.right == 0) return out.push_back(p);
  if (y.right == 0 || (x.right != 0 && x.last - x.first >= y.last - y.first)) {
    out.insert(out.end(), {{p.i + 1, p.j}, {x.right, p.j}});
  } else {
    out.insert(out.end(), {{p.i, p.j + 1}, {p.i, y.right}});
  }
}

void pairs_in_parallel(const PackedTree& a, const PackedTree& b, std::vector<NodePair> work,
                       Crew& crew, PairCollector& out) {
  // Many more pieces than threads, since their costs differ widely.
  constexpr size_t pieces = 32 * chunk_count;
  constexpr int most_steps = 24;
  std::vector<NodePair> next;
  for (int step = 0; step < most_steps && work.size() < pieces; ++step) {
    next.clear();
    for (const NodePair p : work) step_down(a, b, p, next);
    work.swap(next);
  }
  out.in_chunks(
      &crew, work.size(),
      [&](size_t first, size_t last, PairCollector& part) {
        for (size_t k = first; k < last && !stop_requested(); ++k) {
          const auto [i, j] = work[k];
          &a == &b&& i == j ? pairs_below(a, i, part) : pairs_between(a, i, b, j, part);
        }
      },
      0);
}

void pairs_of_one(const PackedTree& t, uint32_t i, const PackedBounds& bounds, uint32_t id,
                  PairCollector& out) {
  const PackedTree::Node& x = t.nodes()[i];
  if (!may_overlap(x.bounds, bounds)) return;
  if (x.right == 0) return out.test(bounds, id, t.members(), x.first, x.last);
  pairs_of_one(t, i + 1, bounds, id, out);
  pairs_of_one(t, x.right, bounds, id, out);
}

}  // namespace

void PackedTree::clear() {
  set_.resize(0);
  nodes_.clear();
}

void PackedTree::remove(size_t position) {
  const float inf = std::numeric_limits<float>::infinity();
  set_.bounds[position] = {Float4(inf), Float4(-inf)};
}

bool PackedTree::sort_by_code(uint32_t first, uint32_t last, std::vector<Coded>& scratch) {
  Aabb centres;
  for (uint32_t k = first; k < last; ++k) centres.include(centre_of(proxies_[coded_[k].id].bounds));
  const double size = centres.extent().maxCoeff();
  if (size < 1e-290) return false;  // else the scale could overflow
  // The same scale for all axes, so that long thin worlds are first split across their length.
  const double scale = 1023.999 / size;
  for (uint32_t k = first; k < last; ++k) {
    const Vec3 x = (centre_of(proxies_[coded_[k].id].bounds) - centres.min) * scale;
    coded_[k].code = spread_bits(uint32_t(x.x())) | spread_bits(uint32_t(x.y())) << 1 |
                     spread_bits(uint32_t(x.z())) << 2;
  }
  const auto from = coded_.begin() + std::ptrdiff_t(first);
  const auto to = coded_.begin() + std::ptrdiff_t(last);
  if (last - first < radix_sort_from) {
    std::sort(from, to, [](const Coded& a, const Coded& b) {
      return a.code != b.code ? a.code < b.code : a.id < b.id;
    });
    return true;
  }
  scratch.resize(std::max<size_t>(scratch.size(), last - first));
  for (int shift = 0; shift < 30; shift += 10) {
    std::array<uint32_t, 1025> starts{};
    for (auto c = from; c != to; ++c) ++starts[((c->code >> shift) & 1023) + 1];
    for (size_t k = 1; k < starts.size(); ++k) starts[k] += starts[k - 1];
    for (auto c = from; c != to; ++c) scratch[starts[(c->code >> shift) & 1023]++] = *c;
    std::copy_n(scratch.begin(), to - from, from);
  }
  return true;
}

uint32_t PackedTree::split(uint32_t first, uint32_t last, std::vector<Coded>& scratch) {
  // Members in the same finest cell of the curve get a curve of their own, so that clusters in a
  // wide world are resolved; members at one and the same place are halved.
  if (coded_[first].code == coded_[last - 1].code && !sort_by_code(first, last, scratch))
    return first + (last - first) / 2;
  const uint32_t bit = std::bit_floor(coded_[first].code ^ coded_[last - 1].code);
  const auto from = coded_.begin() + std::ptrdiff_t(first);
  const auto to = coded_.begin() + std::ptrdiff_t(last);
  const auto middle =
      std::partition_point(from, to, [bit](const Coded& c) { return (c.code & bit) == 0; });
  return uint32_t(middle - coded_.begin());
}

uint32_t PackedTree::add_node(uint32_t first, uint32_t last, Growth& out) {
  std::vector<Node>& nodes = out.nodes;
  const auto index = uint32_t(nodes.size());
  nodes.push_back({{}, first, last, 0});
  if (last - first <= leaf_size) {
    for (uint32_t k = first; k < last; ++k) {
      set_.ids[k] = coded_[k].id;
      set_.bounds[k] = pack(proxies_[coded_[k].id], origin_);
    }
    PackedBounds bounds = set_.bounds[first];
    for (uint32_t k = first + 1; k < last; ++k) bounds.include(set_.bounds[k]);
    nodes[index].bounds = bounds;
    return index;
  }
  const uint32_t middle = split(first, last, out.scratch);
  add_node(first, middle, out);
  const uint32_t right = add_node(middle, last, out);
  nodes[index].right = right;
  nodes[index].bounds = nodes[index + 1].bounds;
  nodes[index].bounds.include(nodes[right].bounds);
  return index;
}

/// The top of the tree is divided first, then the branches are built in parallel, and all nodes are
/// joined in the order in which one thread would have made them.
void PackedTree::build_in_parallel(Crew& crew) {
  struct Twig {
    uint32_t first, last, branch, left, right;  // branch or children
  };
  constexpr uint32_t none = UINT32_MAX;
  const auto n = uint32_t(coded_.size()), most = std::max(n / uint32_t(chunk_count), leaf_size);
  std::vector<Twig> twigs{{0, n, none, none, none}};
  std::vector<uint32_t> starts;  // twigs that are branches
  for (uint32_t k = 0; k < twigs.size(); ++k) {
    const auto [first, last, b, l, r] = twigs[k];
    if (last - first <= most) {
      twigs[k].branch = uint32_t(starts.size());
      starts.push_back(k);
      continue;
    }
    const uint32_t middle = split(first, last, whole_.scratch);
    twigs[k].left = uint32_t(twigs.size());
    twigs.push_back({first, middle, none, none, none});
    twigs[k].right = uint32_t(twigs.size());
    twigs.push_back({middle, last, none, none, none});
  }
  if (branches_.size() < starts.size()) branches_.resize(starts.size());
  crew.each(starts.size(), [&](size_t b) {
    branches_[b].nodes.clear();
    add_node(twigs[starts[b]].first, twigs[starts[b]].last, branches_[b]);
  });
  const auto append = [&](const auto& self, const Twig& t) -> uint32_t {
    const auto index = uint32_t(nodes_.size());
    if (t.branch != none) {
      for (Node node : branches_[t.branch].nodes) {
        if (node.right != 0) node.right += index;
        nodes_.push_back(node);
      }
      return index;
    }
    nodes_.push_back({{}, t.first, t.last, 0});
    self(self, twigs[t.left]);
    const uint32_t right = self(self, twigs[t.right]);
    nodes_[index].right = right;
    nodes_[index].bounds = nodes_[index + 1].bounds;
    nodes_[index].bounds.include(nodes_[right].bounds);
    return index;
  };
  append(append, twigs[0]);
}

void PackedTree::build(std::span<const BroadPhaseProxy> proxies, std::span<const uint32_t> ids,
                       const Vec3& origin, Crew* crew) {
  clear();
  if (ids.empty()) return;
  proxies_ = proxies;
  origin_ = origin;
  coded_.clear();
  for (const uint32_t id : ids) coded_.push_back({0, id});
  set_.resize(ids.size());
  if (crew && ids.size() >= least_branching) {
    build_in_parallel(*crew);
  } else {
    whole_.nodes.swap(nodes_);
    whole_.nodes.clear();
    add_node(0, uint32_t(ids.size()), whole_);
    whole_.nodes.swap(nodes_);
  }
  proxies_ = {};
}

void PackedTree::pairs_within(PairCollector& out, Crew* crew) const {
  if (nodes_.empty()) return;
  if (!crew || set_.size() < least_branching) return pairs_below(*this, 0, out);
  pairs_in_parallel(*this, *this, {{0, 0}}, *crew, out);
}

void PackedTree::pairs_with(const PackedTree& other, PairCollector& out, Crew* crew) const {
  if (nodes_.empty() || other.nodes_.empty()) return;
  if (!crew || set_.size() + other.set_.size() < least_branching)
    return pairs_between(*this, 0, other, 0, out);
  pairs_in_parallel(*this, other, {{0, 0}}, *crew, out);
}

void PackedTree::pairs_with(const PackedBounds& bounds, uint32_t id, PairCollector& out) const {
  if (!nodes_.empty()) pairs_of_one(*this, 0, bounds, id, out);
}

void PackedTree::draw(const Vec3& origin, DebugDraw& out) const {
  std::vector<uint32_t> ends;  // of the members below the ancestors of a node
  for (const Node& n : nodes_) {
    while (!ends.empty() && n.first >= ends.back()) ends.pop_back();
    const auto lo = n.bounds.lo.array(), hi = n.bounds.hi.array();
    draw_box(out, origin + Vec3(lo[0], lo[1], lo[2]), origin + Vec3(hi[0], hi[1], hi[2]),
             level_colour(ends.size()));
    ends.push_back(n.last);
  }
}

}  // namespace tumble
