#include "engine/geometry/decomposition/planar_graph.hpp"

#include "engine/geometry/decomposition/tolerances.hpp"
#include "engine/geometry/predicates/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

namespace tumble {
namespace {

constexpr size_t next(size_t k) {
  return (k + 1) % 3;
}
constexpr size_t last(size_t k) {
  return (k + 2) % 3;
}

/// A triangulation of points within one large triangle.
class Triangulation {
 public:
  struct Face {
    Triangle v, n;  ///< corners; neighbours across the side from corner k to k + 1
    std::array<int, 3> edge{-1, -1, -1};
  };
  struct Side {
    uint32_t face;
    size_t k;
  };

  explicit Triangulation(std::span<const Vec2> points) : points_(points.begin(), points.end()) {
    Vec2 low = points_.front(), high = low;
    for (const Vec2& p : points_) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const Vec2 middle = (low + high) / 2;
    const double far = 64 * std::max((high - low).maxCoeff(), middle.cwiseAbs().maxCoeff() / 1024);
    const auto n = uint32_t(points_.size());
    points_.push_back(middle + Vec2(-far, -far));
    points_.push_back(middle + Vec2(far, -far));
    points_.push_back(middle + Vec2(0, far));
    faces_.push_back({{n, n + 1, n + 2}, {no_index, no_index, no_index}, {}});
    for (int& e : faces_[0].edge) e = -1;
    for (uint32_t p = 0; p < n; ++p) insert(p);
  }

  const std::vector<Face>& faces() const { return faces_; }
  bool sound() const { return sound_; }
  uint32_t outermost() const { return uint32_t(points_.size()) - 1; }

  /// Makes a -> b a side; false when an edge or a point is in its way.
  bool insert_edge(uint32_t a, uint32_t b, int number) {
    if (const auto side = find_side(a, b)) {
      fix(*side, number);
      return true;
    }
    auto crossing = sides_across(a, b);
    if (!crossing) return false;
    for (size_t tries = 0; !crossing->empty(); ++tries) {
      const auto [p, q] = crossing->front();
      crossing->pop_front();
      const auto side = find_side(p, q);
      if (!side || faces_[side->face].edge[side->k] >= 0 || tries > 64 * points_.size())
        return false;
      if (!may_swap(*side)) {
        crossing->push_back({p, q});
        continue;
      }
      const auto [c, d] = swap(*side);
      if (c == a || c == b || d == a || d == b) continue;
      if (turn(a, b, c) * turn(a, b, d) < 0) crossing->push_back({c, d});
    }
    const auto side = find_side(a, b);
    if (side) fix(*side, number);
    return side.has_value();
  }

 private:
  int turn(uint32_t a, uint32_t b, uint32_t c) const {
    return orientation(points_[a], points_[b], points_[c]);
  }
  /// The same side from the other face.
  Side twin(Side s) const {
    const uint32_t other = faces_[s.face].n[s.k], end = faces_[s.face].v[next(s.k)];
    for (size_t k = 0; k < 3; ++k)
      if (faces_[other].v[k] == end && faces_[other].n[k] == s.face) return {other, k};
    return {other, 0};
  }
  void relink(uint32_t face, uint32_t from, uint32_t to) {
    if (face == no_index) return;
    for (uint32_t& n : faces_[face].n)
      if (n == from) {
        n = to;
        return;
      }
  }
  void fix(Side s, int number) {
    faces_[s.face].edge[s.k] = number;
    const Side t = twin(s);
    faces_[t.face].edge[t.k] = number;
  }
  /// The face that has a -> b as a side.
  std::optional<Side> find_side(uint32_t a, uint32_t b) const {
    std::optional<Side> out;
    around(a, [&](Side s) {
      if (faces_[s.face].v[next(s.k)] != b) return true;
      out = s;
      return false;
    });
    return out;
  }
  /// Calls f(side that starts at v) for the faces about v, counter-clockwise, until it returns
  /// false. Points but the outermost have closed fans.
  template <class F>
  void around(uint32_t v, const F& f) const {
    const uint32_t start = face_of_[v];
    uint32_t face = start;
    do {
      size_t k = 0;
      while (faces_[face].v[k] != v) ++k;
      if (!f(Side{face, k})) return;
      face = faces_[face].n[last(k)];
    } while (face != start && face != no_index);
  }

  void insert(uint32_t p) {
    face_of_.resize(points_.size(), 0);
    for (uint32_t f = 0; f < faces_.size(); ++f) {
      std::array<int, 3> turns;
      for (size_t k = 0; k < 3; ++k) turns[k] = turn(faces_[f].v[k], faces_[f].v[next(k)], p);
      if (turns[0] < 0 || turns[1] < 0 || turns[2] < 0) continue;
      const auto zero = std::count(turns.begin(), turns.end(), 0);
      if (zero > 1) break;
      if (zero == 0) {
        split_face(f, p);
      } else {
        split_side({f, size_t(std::find(turns.begin(), turns.end(), 0) - turns.begin())}, p);
      }
      return;
    }
    sound_ = false;
  }

  void split_face(uint32_t f, uint32_t p) {
    const Face old = faces_[f];
    const auto g = uint32_t(faces_.size()), h = g + 1;
    faces_[f] = {{old.v[0], old.v[1], p}, {old.n[0], g, h}, {-1, -1, -1}};
    faces_.push_back({{old.v[1], old.v[2], p}, {old.n[1], h, f}, {-1, -1, -1}});
    faces_.push_back({{old.v[2], old.v[0], p}, {old.n[2], f, g}, {-1, -1, -1}});
    relink(old.n[1], f, g);
    relink(old.n[2], f, h);
    for (const uint32_t face : {f, g, h}) own(face);
    improve({{f, 0}, {g, 0}, {h, 0}});
  }

  /// Both faces of a side are cut in two at a point on it.
  void split_side(Side s, uint32_t p) {
    const Side t = twin(s);
    const uint32_t f = s.face, g = t.face;
    const auto f2 = uint32_t(faces_.size()), g2 = f2 + 1;
    const Face a = faces_[f], b = faces_[g];
    const uint32_t from = a.v[s.k], to = a.v[next(s.k)], left = a.v[last(s.k)],
                   right = b.v[last(t.k)];
    faces_[f] = {{from, p, left}, {g2, f2, a.n[last(s.k)]}, {-1, -1, -1}};
    faces_.push_back({{p, to, left}, {g, a.n[next(s.k)], f}, {-1, -1, -1}});
    faces_[g] = {{to, p, right}, {f2, g2, b.n[last(t.k)]}, {-1, -1, -1}};
    faces_.push_back({{p, from, right}, {f, b.n[next(t.k)], g}, {-1, -1, -1}});
    relink(a.n[next(s.k)], f, f2);
    relink(b.n[next(t.k)], g, g2);
    for (const uint32_t face : {f, f2, g, g2}) own(face);
    improve({{f, 2}, {f2, 1}, {g, 2}, {g2, 1}});
  }

  void own(uint32_t face) {
    for (const uint32_t v : faces_[face].v) face_of_[v] = face;
  }

  /// Whether the two faces of a side make a strictly convex quadrilateral.
  bool may_swap(Side s) const {
    if (faces_[s.face].n[s.k] == no_index) return false;
    const Side t = twin(s);
    const uint32_t a = faces_[s.face].v[s.k], b = faces_[s.face].v[next(s.k)],
                   c = faces_[s.face].v[last(s.k)], d = faces_[t.face].v[last(t.k)];
    return turn(c, a, d) > 0 && turn(d, b, c) > 0;
  }

  /// The other diagonal; its ends.
  std::pair<uint32_t, uint32_t> swap(Side s) {
    const Side t = twin(s);
    const Face f = faces_[s.face], g = faces_[t.face];
    const uint32_t a = f.v[s.k], b = f.v[next(s.k)], c = f.v[last(s.k)], d = g.v[last(t.k)];
    faces_[s.face] = {{c, a, d},
                      {f.n[last(s.k)], g.n[next(t.k)], t.face},
                      {f.edge[last(s.k)], g.edge[next(t.k)], -1}};
    faces_[t.face] = {{d, b, c},
                      {g.n[last(t.k)], f.n[next(s.k)], s.face},
                      {g.edge[last(t.k)], f.edge[next(s.k)], -1}};
    relink(g.n[next(t.k)], t.face, s.face);
    relink(f.n[next(s.k)], s.face, t.face);
    own(s.face);
    own(t.face);
    return {c, d};
  }

  /// Swaps sides whose faces' circles hold the opposite corner, by rounding: of which triangles
  /// there are several good choices, any will do.
  void improve(std::vector<Side> sides) {
    for (size_t tries = 0; !sides.empty() && tries < 64 * points_.size() + 64; ++tries) {
      const Side s = sides.back();
      sides.pop_back();
      if (faces_[s.face].n[s.k] == no_index || !in_circle(s) || !may_swap(s)) continue;
      const uint32_t other = faces_[s.face].n[s.k];
      swap(s);
      sides.push_back({s.face, 0});
      sides.push_back({s.face, 1});
      sides.push_back({other, 0});
      sides.push_back({other, 1});
    }
  }
  bool in_circle(Side s) const {
    const Side t = twin(s);
    const Vec2 d = points_[faces_[t.face].v[last(t.k)]];
    const Vec2 a = points_[faces_[s.face].v[0]] - d, b = points_[faces_[s.face].v[1]] - d,
               c = points_[faces_[s.face].v[2]] - d;
    const double aa = a.squaredNorm(), bb = b.squaredNorm(), cc = c.squaredNorm();
    const double value = aa * (b.x() * c.y() - b.y() * c.x()) +
                         bb * (c.x() * a.y() - c.y() * a.x()) +
                         cc * (a.x() * b.y() - a.y() * b.x());
    const double size = std::max({aa, bb, cc});
    return value > tolerances::in_circle * size * size;
  }

  /// The sides that the line from a to b crosses, in order; nothing when it meets a point.
  std::optional<std::deque<std::pair<uint32_t, uint32_t>>> sides_across(uint32_t a,
                                                                        uint32_t b) const {
    std::deque<std::pair<uint32_t, uint32_t>> out;
    std::optional<Side> at;
    bool blocked = false;
    around(a, [&](Side s) {
      const uint32_t p = faces_[s.face].v[next(s.k)], q = faces_[s.face].v[last(s.k)];
      const int tp = turn(a, b, p), tq = turn(a, b, q);
      if (tp == 0 && turns_towards(a, b, p)) blocked = true;
      if (tp < 0 && tq > 0) at = Side{s.face, next(s.k)};
      return !blocked && !at;
    });
    while (at && !blocked) {
      const uint32_t p = faces_[at->face].v[at->k], q = faces_[at->face].v[next(at->k)];
      out.push_back({p, q});
      if (faces_[at->face].n[at->k] == no_index) return std::nullopt;
      const Side t = twin(*at);
      const uint32_t r = faces_[t.face].v[last(t.k)];
      if (r == b) return out;
      const int side = turn(a, b, r);
      if (side == 0) return std::nullopt;
      // t runs q -> p; leave between p and r when r lies on the left, else between r and q.
      at = Side{t.face, side > 0 ? next(t.k) : last(t.k)};
      if (out.size() > 4 * points_.size()) return std::nullopt;
    }
    return std::nullopt;
  }
  bool turns_towards(uint32_t a, uint32_t b, uint32_t p) const {
    return (points_[b] - points_[a]).dot(points_[p] - points_[a]) > 0;
  }

  std::vector<Vec2> points_;
  std::vector<Face> faces_;
  std::vector<uint32_t> face_of_;
  bool sound_ = true;
};

/// Winding numbers of all faces, from 0 outside; nothing when they are not 0 or 1.
std::optional<std::vector<int>> winding_numbers(const Triangulation& cut,
                                                std::span<const PlanarEdge> edges) {
  const auto& faces = cut.faces();
  std::vector<int> out(faces.size(), -1);
  std::vector<uint32_t> stack;
  for (uint32_t f = 0; f < faces.size() && stack.empty(); ++f)
    for (const uint32_t v : faces[f].v)
      if (v == cut.outermost()) {
        out[f] = 0;
        stack.assign(1, f);
      }
  while (!stack.empty()) {
    const uint32_t f = stack.back();
    stack.pop_back();
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t n = faces[f].n[k];
      if (n == no_index) continue;
      int turns = out[f];
      if (const int e = faces[f].edge[k]; e >= 0) {
        const PlanarEdge& edge = edges[size_t(e)];
        turns -= faces[f].v[k] == edge.a ? edge.turns : -edge.turns;
      }
      if (turns < 0 || turns > 1) return std::nullopt;
      if (out[n] < 0) {
        out[n] = turns;
        stack.push_back(n);
      } else if (out[n] != turns) {
        return std::nullopt;
      }
    }
  }
  return out;
}

}  // namespace

std::optional<PlanarCover> triangulate_graph(std::span<const Vec2> points,
                                             std::span<const PlanarEdge> edges) {
  PlanarCover out;
  if (points.size() < 3) return out;
  Triangulation cut(points);
  if (!cut.sound()) return std::nullopt;
  for (size_t e = 0; e < edges.size(); ++e)
    if (!cut.insert_edge(edges[e].a, edges[e].b, int(e))) return std::nullopt;
  const auto winding = winding_numbers(cut, edges);
  if (!winding) return std::nullopt;
  const auto& faces = cut.faces();
  std::vector<uint32_t> number(faces.size(), no_index);
  uint32_t count = 0;
  for (size_t f = 0; f < faces.size(); ++f)
    if ((*winding)[f] == 1) number[f] = count++;
  for (size_t f = 0; f < faces.size(); ++f) {
    if (number[f] == no_index) continue;
    out.triangles.push_back(faces[f].v);
    Triangle& n = out.neighbours.emplace_back();
    for (size_t k = 0; k < 3; ++k)
      n[k] = faces[f].n[k] == no_index ? no_index : number[faces[f].n[k]];
    out.edge.push_back(faces[f].edge);
  }
  return out;
}

}  // namespace tumble
