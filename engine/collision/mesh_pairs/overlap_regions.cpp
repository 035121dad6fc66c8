#include "engine/collision/mesh_pairs/overlap_regions.hpp"

#include "engine/core/disjoint_sets.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Share of the sum of the loops' areas below which a region's vector area counts as cancelled.
constexpr double cancelled = 0.1;
/// The direction of a contour narrower than this share of the surfaces' sizes is determined by
/// rounding.
constexpr double narrow = 1e-13;

/// What a segment adds to the vector area of its loop.
struct LoopArea {
  uint32_t loop, segment;
  Vec3 area;
};

/// Memory that is kept from pair to pair.
struct RegionScratch {
  DisjointSets sets;
  std::vector<uint32_t> loop;                    ///< root of each node by segments alone
  std::vector<uint32_t> stack, outside, number;  ///< number: region of each root
  std::array<std::vector<uint32_t>, 2> mark;     ///< by vertex: 0, or 1 + a node of its region
  std::vector<LoopArea> areas;
};

class RegionFinder {
 public:
  RegionFinder(const PlacedSurface& A, const PlacedSurface& B, const OverlapContours& contours,
               RegionScratch& scratch, OverlapRegions& out)
      : surfaces_{&A, &B}, contours_(contours), s_(scratch), out_(out) {}

  void run() {
    out_.regions.clear();
    out_.sound = contours_.sound;
    const auto& nodes = contours_.nodes;
    s_.sets.reset(nodes.size());
    for (const ContourSegment& c : contours_.segments) s_.sets.join(c.from, c.to);
    s_.loop.resize(nodes.size());
    for (uint32_t i = 0; i < nodes.size(); ++i) s_.loop[i] = s_.sets.root(i);
    for (size_t side = 0; side < 2; ++side) flood(side);
    number_regions();
    measure();
  }

 private:
  const MeshTopology& topology(size_t side) const { return surfaces_[side]->s.topology; }

  /// Nodes of one side; they are sorted by it.
  std::span<const ContourNode> nodes_of(size_t side) const {
    const auto first = std::partition_point(contours_.nodes.begin(), contours_.nodes.end(),
                                            [](const ContourNode& n) { return !n.of_b; });
    if (side == 0) return {contours_.nodes.begin(), first};
    return {first, contours_.nodes.end()};
  }

  /// Marks the vertices inside, along edges from the contour.
  void flood(size_t side) {
    auto& mark = s_.mark[side];
    mark.resize(std::max(mark.size(), surfaces_[side]->s.mesh->vertices.size()), 0);
    out_.vertices[side].clear(), out_.pieces[side].clear();
    s_.outside.clear(), s_.stack.clear();
    const auto nodes = nodes_of(side);
    const auto base = uint32_t(nodes.data() - contours_.nodes.data());
    for (size_t first = 0; first < nodes.size();) {
      size_t last = first + 1;
      while (last < nodes.size() && nodes[last].same_edge(nodes[first])) ++last;
      edge_pieces(side, base + uint32_t(first), base + uint32_t(last));
      first = last;
    }
    while (!s_.stack.empty()) {
      const uint32_t v = s_.stack.back();
      s_.stack.pop_back();
      spread(side, v, nodes);
    }
    for (uint32_t v : s_.outside) out_.sound = out_.sound && mark[v] == 0;
    for (InsideVertex& v : out_.vertices[side]) {
      v.region = mark[v.vertex] - 1;
      mark[v.vertex] = 0;
    }
  }

  /// The parts inside of one edge, between its crossings [first, last).
  void edge_pieces(size_t side, uint32_t first, uint32_t last) {
    const auto& nodes = contours_.nodes;
    const MeshEdge& edge = topology(side).edges[nodes[first].edge];
    const uint32_t id = nodes[first].edge;
    if (nodes[first].entering) {
      s_.outside.push_back(edge.vertices[0]);
    } else {
      out_.pieces[side].push_back({id, first, 0, nodes[first].s});
      reach(side, edge.vertices[0], first);
    }
    for (uint32_t i = first; i + 1 < last; ++i) {
      if (nodes[i].entering == nodes[i + 1].entering) out_.sound = false;
      if (!nodes[i].entering) continue;
      out_.pieces[side].push_back({id, i, nodes[i].s, nodes[i + 1].s});
      s_.sets.join(i, i + 1);
    }
    if (nodes[last - 1].entering) {
      out_.pieces[side].push_back({id, last - 1, nodes[last - 1].s, 1});
      reach(side, edge.vertices[1], last - 1);
    } else {
      s_.outside.push_back(edge.vertices[1]);
    }
  }

  void reach(size_t side, uint32_t vertex, uint32_t node) {
    uint32_t& mark = s_.mark[side][vertex];
    if (mark) {
      s_.sets.join(mark - 1, node);
      return;
    }
    mark = node + 1;
    out_.vertices[side].push_back({vertex, node});
    s_.stack.push_back(vertex);
  }

  void spread(size_t side, uint32_t v, std::span<const ContourNode> nodes) {
    const uint32_t node = s_.mark[side][v] - 1;
    for (uint32_t e : topology(side).edges_of_vertex(v)) {
      const auto at = std::partition_point(nodes.begin(), nodes.end(),
                                           [e](const ContourNode& n) { return n.edge < e; });
      if (at != nodes.end() && at->edge == e) continue;
      const auto& ends = topology(side).edges[e].vertices;
      if (ends[0] == v) out_.pieces[side].push_back({e, node, 0, 1});
      reach(side, ends[0] == v ? ends[1] : ends[0], node);
    }
  }

  /// Assigns regions to nodes, in the order of their first nodes.
  void number_regions() {
    const size_t n = contours_.nodes.size();
    s_.number.assign(n, 0);
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t root = s_.sets.root(i);
      if (root == i) {
        s_.number[i] = uint32_t(out_.regions.size());
        out_.regions.emplace_back();
      }
    }
    for (size_t side = 0; side < 2; ++side) {
      for (InsideVertex& v : out_.vertices[side]) v.region = region_of(v.region);
      for (InsidePiece& p : out_.pieces[side]) p.region = region_of(p.region);
      std::sort(out_.vertices[side].begin(), out_.vertices[side].end(),
                [](const InsideVertex& x, const InsideVertex& y) {
                  return x.region != y.region ? x.region < y.region : x.vertex < y.vertex;
                });
      std::sort(out_.pieces[side].begin(), out_.pieces[side].end(),
                [](const InsidePiece& x, const InsidePiece& y) {
                  if (x.region != y.region) return x.region < y.region;
                  return x.edge != y.edge ? x.edge < y.edge : x.from < y.from;
                });
    }
  }
  uint32_t region_of(uint32_t node) { return s_.number[s_.sets.root(node)]; }

  void measure() {
    const auto& nodes = contours_.nodes;
    s_.outside.assign(out_.regions.size(), 0);  // used for counts from here on
    for (uint32_t i = 0; i < nodes.size(); ++i) {
      const uint32_t r = region_of(i);
      out_.regions[r].box.include(nodes[i].x);
      out_.regions[r].centre += nodes[i].x;
      ++s_.outside[r];
    }
    for (size_t r = 0; r < out_.regions.size(); ++r) out_.regions[r].centre /= s_.outside[r];
    for (size_t side = 0; side < 2; ++side)
      for (const InsideVertex& v : out_.vertices[side])
        out_.regions[v.region].box.include(surfaces_[side]->vertex(v.vertex));
    s_.areas.clear();
    for (uint32_t k = 0; k < contours_.segments.size(); ++k) {
      const ContourSegment& c = contours_.segments[k];
      OverlapRegion& region = out_.regions[region_of(c.from)];
      const Vec3 area =
          0.5 * (nodes[c.from].x - region.centre).cross(nodes[c.to].x - region.centre);
      region.area += area;
      s_.areas.push_back({s_.loop[c.from], k, area});
    }
    find_normals();
    find_heights();
  }

  void find_normals() {
    thread_local std::vector<double> gross;
    gross.assign(out_.regions.size(), 0);
    std::sort(s_.areas.begin(), s_.areas.end(), [](const LoopArea& x, const LoopArea& y) {
      return x.loop != y.loop ? x.loop < y.loop : x.segment < y.segment;
    });
    for (size_t i = 0; i < s_.areas.size();) {
      const uint32_t loop = s_.areas[i].loop;
      Vec3 sum = Vec3::Zero();
      for (; i < s_.areas.size() && s_.areas[i].loop == loop; ++i) sum += s_.areas[i].area;
      gross[region_of(loop)] += sum.norm();
    }
    const double width = narrow * (surfaces_[0]->s.size + surfaces_[1]->s.size);
    for (size_t r = 0; r < out_.regions.size(); ++r) {
      OverlapRegion& region = out_.regions[r];
      const double net = region.area.norm(), length = region.box.extent().norm();
      if (net > cancelled * gross[r] && net > width * length) region.normal = region.area / net;
    }
  }

  void find_heights() {
    thread_local std::vector<std::pair<double, double>> spans;
    spans.assign(out_.regions.size(), {0, 0});
    const auto include = [&](uint32_t r, const Vec3& x) {
      const double h = out_.regions[r].normal.dot(x - out_.regions[r].centre);
      spans[r] = {std::min(spans[r].first, h), std::max(spans[r].second, h)};
    };
    for (uint32_t i = 0; i < contours_.nodes.size(); ++i)
      include(region_of(i), contours_.nodes[i].x);
    for (size_t side = 0; side < 2; ++side)
      for (const InsideVertex& v : out_.vertices[side])
        include(v.region, surfaces_[side]->vertex(v.vertex));
    for (size_t r = 0; r < spans.size(); ++r)
      out_.regions[r].height = spans[r].second - spans[r].first;
  }

  std::array<const PlacedSurface*, 2> surfaces_;
  const OverlapContours& contours_;
  RegionScratch& s_;
  OverlapRegions& out_;
};

}  // namespace

void find_regions(const PlacedSurface& A, const PlacedSurface& B, const OverlapContours& contours,
                  OverlapRegions& out) {
  thread_local RegionScratch scratch;
  RegionFinder(A, B, contours, scratch, out).run();
}

}  // namespace tumble
