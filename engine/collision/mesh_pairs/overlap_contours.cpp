#include "engine/collision/mesh_pairs/overlap_contours.hpp"

#include <algorithm>
#include <array>
#include <tuple>

namespace tumble {
namespace {

/// A triangle with the numbers of its vertices, query frame.
struct Placed {
  uint32_t id;
  Triangle vertex;
  std::array<Vec3, 3> p;
  Vec3 normal;  ///< not unit
};

Placed place(const PlacedSurface& S, uint32_t t) {
  Placed out;
  out.id = t;
  out.vertex = S.s.mesh->triangles[t];
  for (size_t k = 0; k < 3; ++k) out.p[k] = S.vertex(out.vertex[k]);
  out.normal = (out.p[1] - out.p[0]).cross(out.p[2] - out.p[0]);
  return out;
}

using Heights = std::array<double, 3>;

Heights heights(const Placed& over, const Placed& t) {
  Heights h;
  for (size_t k = 0; k < 3; ++k) h[k] = over.normal.dot(t.p[k] - over.p[0]);
  return h;
}

bool straddles(const Heights& h) {
  const bool first = h[0] > 0;
  return (h[1] > 0) != first || (h[2] > 0) != first;
}

/// Whether the line from p to q passes all sides of the triangle in the same sense.
bool passes_inside(const Vec3& p, const Vec3& q, const Placed& t) {
  const Vec3 along = q - p;
  const std::array<Vec3, 3> corner{t.p[0] - p, t.p[1] - p, t.p[2] - p};
  const auto passes = [&](size_t k, size_t l) {
    const bool ascending = t.vertex[k] < t.vertex[l];
    const Vec3 &u = corner[ascending ? k : l], &v = corner[ascending ? l : k];
    return (along.dot(u.cross(v)) > 0) == ascending;
  };
  const bool first = passes(0, 1);
  return passes(1, 2) == first && passes(2, 0) == first;
}

class ContourFinder {
 public:
  ContourFinder(const PlacedSurface& A, const PlacedSurface& B, OverlapContours& out)
      : A_(A), B_(B), out_(out) {}

  void run(std::span<const TriangleIds> pairs) {
    out_.nodes.clear(), out_.segments.clear();
    out_.sound = true;
    Placed a;
    a.id = no_index;
    for (const TriangleIds& ids : pairs) {
      if (a.id != ids.a) a = place(A_, ids.a);
      pair(a, place(B_, ids.b));
    }
    number_nodes();
  }

 private:
  void pair(const Placed& a, const Placed& b) {
    const Heights of_a = heights(b, a), of_b = heights(a, b);
    if (!straddles(of_a) || !straddles(of_b)) return;
    const size_t first = out_.nodes.size();
    pierce(a, b, of_a, A_, false);
    pierce(b, a, of_b, B_, true);
    const size_t found = out_.nodes.size() - first;
    if (found == 0) return;
    if (found != 2) {
      out_.sound = false;
      if (found == 1) return;
    }
    const auto i = uint32_t(first), j = uint32_t(first + 1);
    const bool forward = a.normal.cross(b.normal).dot(out_.nodes[j].x - out_.nodes[i].x) >= 0;
    out_.segments.push_back(forward ? ContourSegment{i, j} : ContourSegment{j, i});
  }

  void pierce(const Placed& from, const Placed& through, const Heights& h, const PlacedSurface& S,
              bool of_b) {
    for (size_t k = 0; k < 3; ++k) {
      const size_t l = (k + 1) % 3;
      if ((h[k] > 0) == (h[l] > 0)) continue;
      const uint32_t edge = S.s.topology.face_edges[from.id][k];
      if (edge == no_index) continue;
      const bool ascending = from.vertex[k] < from.vertex[l];
      const size_t i = ascending ? k : l, j = ascending ? l : k;
      if (!passes_inside(from.p[i], from.p[j], through)) continue;
      const double s = h[i] / (h[i] - h[j]);
      out_.nodes.push_back(
          {of_b, edge, through.id, s, from.p[i] + s * (from.p[j] - from.p[i]), h[i] > 0});
    }
  }

  /// Merges equal nodes: until here every segment has two nodes of its own.
  void number_nodes() {
    thread_local std::vector<uint32_t> order, number, ends;
    auto& nodes = out_.nodes;
    order.resize(nodes.size());
    for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto key = [&](uint32_t i) {
      const ContourNode& n = nodes[i];
      return std::tuple(n.of_b, n.edge, n.s, n.triangle);
    };
    std::sort(order.begin(), order.end(), [&](uint32_t i, uint32_t j) {
      return std::tuple(key(i), i) < std::tuple(key(j), j);
    });
    number.resize(nodes.size());
    thread_local std::vector<ContourNode> unique;
    unique.clear();
    for (size_t k = 0; k < order.size(); ++k) {
      if (k == 0 || key(order[k]) != key(order[k - 1])) unique.push_back(nodes[order[k]]);
      number[order[k]] = uint32_t(unique.size() - 1);
    }
    nodes.swap(unique);
    ends.assign(nodes.size(), 0);
    for (ContourSegment& s : out_.segments) {
      s = {number[s.from], number[s.to]};
      ends[s.from] += 1;
      ends[s.to] += 1u << 16;
    }
    for (uint32_t e : ends) out_.sound = out_.sound && e == (1u | 1u << 16);
  }

  const PlacedSurface &A_, &B_;
  OverlapContours& out_;
};

}  // namespace

void find_contours(const PlacedSurface& A, const PlacedSurface& B,
                   std::span<const TriangleIds> pairs, OverlapContours& out) {
  ContourFinder(A, B, out).run(pairs);
}

}  // namespace tumble
