#include "engine/geometry/wrap/simplify_wrap.hpp"

#include "engine/core/stop.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"
#include "engine/geometry/wrap/changing_tree.hpp"
#include "engine/geometry/wrap/surface_clash.hpp"
#include "engine/geometry/wrap/tolerances.hpp"

#include <algorithm>
#include <queue>

namespace tumble {
namespace {

/// Sum of weighted squared distances from planes: x.A x - 2 b.x + c.
struct Quadric {
  Mat3 A = Mat3::Zero();
  Vec3 b = Vec3::Zero();
  double c = 0;

  void add_plane(const Vec3& n, double at, double weight) {
    A += weight * (n * n.transpose());
    b += weight * at * n;
    c += weight * at * at;
  }
  void add(const Quadric& q) {
    A += q.A;
    b += q.b;
    c += q.c;
  }
  double at(const Vec3& x) const { return std::max(0.0, x.dot(A * x) - 2 * b.dot(x) + c); }
  /// Where it is least, as near to x as that leaves free.
  Vec3 least_from(Vec3 x) const {
    // The share of the trace that is added is taken out again by repetition, a million times each.
    const Mat3 inverse = (A + 1e-6 * A.trace() * Mat3::Identity()).inverse();
    for (int n = 0; n < 3; ++n) x += inverse * (b - A * x);
    return x;
  }
};

/// An edge that may be contracted, with what that cost when it was looked at.
struct Offer {
  double key;
  uint32_t u, v;
  bool operator>(const Offer& o) const {
    return key != o.key ? key > o.key : u != o.u ? u > o.u : v > o.v;
  }
};

/// What an edge is contracted to; not fit where it may not be.
struct Contraction {
  bool fit = false;
  double key = 0;
  Vec3 to = Vec3::Zero();
};

class Simplifying {
 public:
  Simplifying(TriangleMesh& wrap, const EnclosedMesh& mesh, const WrapError& error)
      : wrap_(wrap),
        mesh_(mesh),
        tolerance_(error.tolerance),
        cell_(error.cell),
        longest_(error.longest_edge),
        middle_(bounds(wrap).centre()),
        tree_(wrap) {
    start();
  }

  /// Contracts short edges in the order in which they stand.
  void even_out();
  /// Contracts what can be, the cheapest first; how many edges.
  size_t pass();
  void compact();

 private:
  void start();
  bool alive(uint32_t t) const { return wrap_.triangles[t][0] != no_index; }
  /// Calls f(triangle, corner) for the triangles about a vertex.
  template <class F>
  void each_around(uint32_t v, const F& f) const {
    for (uint32_t c = first_[v]; c != no_index; c = next_[c])
      if (alive(c / 3)) f(c / 3, c % 3);
  }
  void neighbours(uint32_t v, std::vector<uint32_t>& out) const;
  void offer(uint32_t u, uint32_t v);
  Contraction contraction(uint32_t u, uint32_t v) const;
  bool contract(uint32_t u, uint32_t v, const Vec3& to);
  bool linked_well(uint32_t u, uint32_t v);
  void gather_star(uint32_t u, uint32_t v);
  bool shapes_stay(uint32_t u, uint32_t v, const Vec3& to, bool& same_planes) const;
  bool keeps_mesh(uint32_t u, uint32_t v, const Vec3& to);
  bool clashes(uint32_t u, uint32_t v, const Vec3& to);
  void apply(uint32_t u, uint32_t v, const Vec3& to);
  /// Corners of a triangle of the star with u and v at `to`.
  TriangleCorners moved(uint32_t t, uint32_t u, uint32_t v, const Vec3& to) const {
    TriangleCorners out;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t i = wrap_.triangles[t][k];
      out[k] = i == u || i == v ? to : wrap_.vertices[i];
    }
    return out;
  }

  TriangleMesh& wrap_;
  const EnclosedMesh& mesh_;
  const double tolerance_, cell_, longest_;
  const Vec3 middle_;  ///< origin of the quadrics
  ChangingTree tree_;
  std::vector<Quadric> quadrics_;
  std::vector<uint32_t> first_, last_, next_;  ///< lists of the corners at each vertex
  std::priority_queue<Offer, std::vector<Offer>, std::greater<>> queue_;
  std::vector<uint32_t> star_;   ///< triangles at u or v that stay
  std::vector<uint32_t> dying_;  ///< those at both
  std::vector<uint32_t> around_u_, around_v_, common_, witnesses_;
};

void Simplifying::start() {
  const size_t count = wrap_.vertices.size();
  quadrics_.resize(count);
  first_.assign(count, no_index), last_.assign(count, no_index);
  next_.assign(3 * wrap_.triangles.size(), no_index);
  for (uint32_t t = 0; t < wrap_.triangles.size(); ++t) {
    const Vec3 area = face_area_vector(wrap_, t);
    const double size = area.norm();
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t v = wrap_.triangles[t][k], c = 3 * t + k;
      (first_[v] == no_index ? first_[v] : next_[last_[v]]) = c;
      last_[v] = c;
      if (!(size > 0)) continue;
      const Vec3 n = area / size;
      quadrics_[v].add_plane(n, n.dot(wrap_.corner(t, 0) - middle_), size / (cell_ * cell_));
    }
  }
}

void Simplifying::neighbours(uint32_t v, std::vector<uint32_t>& out) const {
  out.clear();
  // Closed: each neighbour follows v in one triangle.
  each_around(v, [&](uint32_t t, uint32_t k) { out.push_back(wrap_.triangles[t][(k + 1) % 3]); });
  std::sort(out.begin(), out.end());
}

Contraction Simplifying::contraction(uint32_t u, uint32_t v) const {
  const Vec3 &a = wrap_.vertices[u], &b = wrap_.vertices[v];
  const double length = (a - b).squaredNorm();
  if (length > 0.25 * longest_ * longest_) return {};
  Quadric sum = quadrics_[u];
  sum.add(quadrics_[v]);
  const Vec3 middle = 0.5 * (a + b);
  Vec3 to = sum.least_from(middle - middle_) + middle_;
  double error = sum.at(to - middle_);
  // An end that is as good leaves the triangles in their planes, bit by bit.
  const double as_good = tolerances::same_wrap_place * tolerances::same_wrap_place * cell_ * cell_;
  const double at_a = sum.at(a - middle_), at_b = sum.at(b - middle_);
  if (std::min(at_a, at_b) <= error + as_good) {
    to = at_a <= at_b ? a : b;
    error = std::min(at_a, at_b);
  }
  const bool fit = error <= tolerance_ * tolerance_ &&
                   (to - middle).squaredNorm() <= length * tolerances::farthest_end;
  return {fit, error + tolerances::length_weight * length, to};
}

void Simplifying::offer(uint32_t u, uint32_t v) {
  if (u > v) std::swap(u, v);
  if (const Contraction c = contraction(u, v); c.fit) queue_.push({c.key, u, v});
}

/// The contraction keeps a 2-manifold: the ends have two neighbours in common, and those have more
/// than three triangles each (Dey et al., "Topology preserving edge contraction", 1999).
bool Simplifying::linked_well(uint32_t u, uint32_t v) {
  neighbours(u, around_u_);
  neighbours(v, around_v_);
  common_.clear();
  std::set_intersection(around_u_.begin(), around_u_.end(), around_v_.begin(), around_v_.end(),
                        std::back_inserter(common_));
  if (common_.size() != 2) return false;
  for (const uint32_t w : common_) {
    size_t count = 0;
    each_around(w, [&](uint32_t, uint32_t) { ++count; });
    if (count <= 3) return false;
  }
  return true;
}

void Simplifying::gather_star(uint32_t u, uint32_t v) {
  star_.clear(), dying_.clear();
  each_around(u, [&](uint32_t t, uint32_t) {
    const Triangle& at = wrap_.triangles[t];
    (at[0] == v || at[1] == v || at[2] == v ? dying_ : star_).push_back(t);
  });
  each_around(v, [&](uint32_t t, uint32_t) {
    const Triangle& at = wrap_.triangles[t];
    if (at[0] != u && at[1] != u && at[2] != u) star_.push_back(t);
  });
}

/// No triangle turns over, becomes a needle or too long; `same_planes`: each stays in its plane.
bool Simplifying::shapes_stay(uint32_t u, uint32_t v, const Vec3& to, bool& same_planes) const {
  same_planes = to == wrap_.vertices[u] || to == wrap_.vertices[v];
  const auto flatness = [](const TriangleCorners& t, const Vec3& normal) {
    const double longest = std::max(
        {(t[1] - t[0]).squaredNorm(), (t[2] - t[1]).squaredNorm(), (t[0] - t[2]).squaredNorm()});
    return normal.norm() / longest;
  };
  double least_before = 1, least_after = 1;
  for (const std::vector<uint32_t>* part : {&star_, &dying_})
    for (const uint32_t t : *part) {
      const TriangleCorners before = corners(wrap_, t);
      const Vec3 n0 = (before[1] - before[0]).cross(before[2] - before[0]);
      least_before = std::min(least_before, flatness(before, n0));
      if (part == &dying_) continue;
      const TriangleCorners after = moved(t, u, v, to);
      const Vec3 n1 = (after[1] - after[0]).cross(after[2] - after[0]);
      least_after = std::min(least_after, flatness(after, n1));
      for (size_t k = 0; k < 3; ++k)
        if (after[k] == to &&
            std::max((after[(k + 1) % 3] - to).squaredNorm(),
                     (after[(k + 2) % 3] - to).squaredNorm()) > longest_ * longest_)
          return false;
      const double sizes = n0.norm() * n1.norm();
      if (!(n0.dot(n1) > tolerances::least_turn_cosine * sizes)) return false;
      if (n0.cross(n1).norm() > tolerances::same_plane * sizes) same_planes = false;
    }
  return least_after >= std::min(least_before, tolerances::least_height);
}

bool Simplifying::keeps_mesh(uint32_t u, uint32_t v, const Vec3& to) {
  Aabb swept;
  for (const std::vector<uint32_t>* part : {&star_, &dying_})
    for (const uint32_t t : *part)
      for (const Vec3& p : corners(wrap_, t)) swept.include(p);
  swept.include(to);
  witnesses_.clear();
  mesh_.witnesses_in(swept, witnesses_);
  for (const uint32_t n : witnesses_) {
    // How often the surface winds about it may not change; what both have in common cancels.
    const Vec3& p = mesh_.witnesses()[n];
    int winding = 0;
    for (const uint32_t t : star_)
      winding += ray_crossing(p, moved(t, u, v, to)) - ray_crossing(p, corners(wrap_, t));
    for (const uint32_t t : dying_) winding -= ray_crossing(p, corners(wrap_, t));
    if (winding != 0) return false;
  }
  return std::all_of(star_.begin(), star_.end(),
                     [&](uint32_t t) { return mesh_.clear_of(moved(t, u, v, to)); });
}

bool Simplifying::clashes(uint32_t u, uint32_t v, const Vec3& to) {
  const auto numbered = [&](uint32_t t) {
    NumberedTriangle out{wrap_.triangles[t], moved(t, u, v, to)};
    for (uint32_t& i : out.id)
      if (i == v) i = u;
    return out;
  };
  for (size_t i = 0; i < star_.size(); ++i) {
    const NumberedTriangle own = numbered(star_[i]);
    for (size_t j = 0; j < i; ++j)
      if (clash(own, numbered(star_[j]))) return true;
    Aabb box;
    for (const Vec3& p : own.at) box.include(p);
    bool met = false;
    tree_.each(box, [&](uint32_t other) {
      const Triangle& id = wrap_.triangles[other];
      if (met || std::any_of(id.begin(), id.end(), [&](uint32_t k) { return k == u || k == v; }))
        return;
      met = clash(own, {id, corners(wrap_, other)});
    });
    if (met) return true;
  }
  return false;
}

void Simplifying::apply(uint32_t u, uint32_t v, const Vec3& to) {
  for (const uint32_t t : dying_) {
    wrap_.triangles[t].fill(no_index);
    tree_.remove(t);
  }
  wrap_.vertices[u] = to;
  for (const uint32_t t : star_) {
    for (uint32_t& i : wrap_.triangles[t])
      if (i == v) i = u;
    tree_.set(t, triangle_bounds(wrap_, t));
  }
  next_[last_[u]] = first_[v];
  last_[u] = last_[v];
  first_[v] = no_index;
  quadrics_[u].add(quadrics_[v]);
  // What has gone is taken out of the list.
  uint32_t* from = &first_[u];
  for (uint32_t k = first_[u]; k != no_index; k = next_[k]) {
    if (!alive(k / 3)) continue;
    *from = k;
    from = &next_[k];
    last_[u] = k;
  }
  *from = no_index;
}

bool Simplifying::contract(uint32_t u, uint32_t v, const Vec3& to) {
  if (!linked_well(u, v)) return false;
  gather_star(u, v);
  bool same_planes = false;
  if (!shapes_stay(u, v, to, same_planes)) return false;
  if (clashes(u, v, to) || (!same_planes && !keeps_mesh(u, v, to))) return false;
  apply(u, v, to);
  return true;
}

void Simplifying::even_out() {
  for (uint32_t t = 0; t < wrap_.triangles.size() && !stop_requested(); ++t)
    for (size_t k = 0; k < 3 && alive(t); ++k) {
      const uint32_t a = wrap_.triangles[t][k], b = wrap_.triangles[t][(k + 1) % 3];
      const Contraction c = contraction(std::min(a, b), std::max(a, b));
      if (c.fit) contract(std::min(a, b), std::max(a, b), c.to);
    }
}

size_t Simplifying::pass() {
  for (const Triangle& t : wrap_.triangles)
    for (size_t k = 0; k < 3 && t[0] != no_index && !stop_requested(); ++k)
      if (t[k] < t[(k + 1) % 3]) offer(t[k], t[(k + 1) % 3]);
  size_t count = 0;
  std::vector<uint32_t> around;
  while (!queue_.empty() && !stop_requested()) {
    const Offer best = queue_.top();
    queue_.pop();
    if (first_[best.u] == no_index || first_[best.v] == no_index) continue;
    // What has changed since was offered again.
    const Contraction c = contraction(best.u, best.v);
    if (!c.fit || c.key != best.key || !contract(best.u, best.v, c.to)) continue;
    ++count;
    neighbours(best.u, around);
    for (const uint32_t w : around) offer(best.u, w);
  }
  return count;
}

void Simplifying::compact() {
  std::vector<uint32_t> number(wrap_.vertices.size(), no_index);
  std::vector<Vec3> kept;
  std::erase_if(wrap_.triangles, [](const Triangle& t) { return t[0] == no_index; });
  for (Triangle& t : wrap_.triangles)
    for (uint32_t& v : t) {
      if (number[v] == no_index) {
        number[v] = uint32_t(kept.size());
        kept.push_back(wrap_.vertices[v]);
      }
      v = number[v];
    }
  wrap_.vertices = std::move(kept);
}

}  // namespace

void even_out_wrap(TriangleMesh& wrap, const EnclosedMesh& mesh, const WrapError& error) {
  Simplifying work(wrap, mesh, error);
  work.even_out();
  work.compact();
}

void simplify_wrap(TriangleMesh& wrap, const EnclosedMesh& mesh, const WrapError& error) {
  Simplifying work(wrap, mesh, error);
  // What was blocked may be free when all else has been contracted.
  for (size_t before = wrap.triangles.size(), done = before; done * 10 > before;) {
    done = work.pass();
    before -= std::min(before, 2 * done);
    if (stop_requested()) break;
  }
  work.compact();
}

}  // namespace tumble
