#include "engine/collision/gjk/epa.hpp"

#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr int max_vertices = 160;
constexpr int max_faces = 6 * max_vertices;  // dead ones are not reused

/// Heights over a face below this share of the difference's size count as in its plane.
constexpr double coplanar = 1e-12;

/// A triangle of the polytope. Side k runs from corner k to k + 1, with face `next[k]` beyond it,
/// whose side `next_side[k]` is the same one.
struct Face {
  std::array<int, 3> corner, next, next_side;
  Vec3 normal;
  double offset;
  bool alive;
};

/// The polytope that grows inside the difference towards the face nearest to the origin.
class Polytope {
 public:
  Polytope(const PlacedCore& A, const PlacedCore& B) : A_(A), B_(B) {}

  /// A tetrahedron from the simplex. False when the difference is flat; best() then has depth 0.
  bool start(const Simplex& simplex);
  void expand(EpaResult& r, double tolerance);
  const Vec3& best_normal() const { return best_normal_; }
  double best_depth() const { return best_depth_; }

 private:
  DifferencePoint probe(const Vec3& n);
  int add_vertex(const DifferencePoint& p);
  int add_face(int i, int j, int k);
  void link(int f, int side, int g, int other_side);
  bool grow(int f, int side, int vertex);
  int nearest_face() const;
  void witness(const Face& f, EpaResult& r) const;

  const PlacedCore& A_;
  const PlacedCore& B_;
  std::array<DifferencePoint, max_vertices> vertices_;
  std::array<Face, max_faces> faces_;
  int vertex_count_ = 0, face_count_ = 0;
  double size_ = 0;
  Vec3 best_normal_ = Vec3::UnitY();
  double best_depth_ = std::numeric_limits<double>::infinity();
  int first_new_ = -1, last_new_ = -1;  ///< faces of the fan being built
};

/// Support along unit n; the least height found so far is the depth that is answered.
DifferencePoint Polytope::probe(const Vec3& n) {
  const DifferencePoint p = support(A_, B_, n);
  const double height = n.dot(p.w);
  if (height < best_depth_) best_depth_ = height, best_normal_ = n;
  return p;
}

int Polytope::add_vertex(const DifferencePoint& p) {
  vertices_[size_t(vertex_count_)] = p;
  size_ = std::max(size_, p.w.norm());
  return vertex_count_++;
}

int Polytope::add_face(int i, int j, int k) {
  const Vec3 &a = vertices_[size_t(i)].w, &b = vertices_[size_t(j)].w, &c = vertices_[size_t(k)].w;
  Face& f = faces_[size_t(face_count_)];
  f.corner = {i, j, k};
  f.alive = true;
  const Vec3 n = (b - a).cross(c - a);
  const double length = n.norm();
  if (!(length > 1e-30)) {
    f.normal = Vec3::Zero();
    f.offset = std::numeric_limits<double>::infinity();  // a sliver: never the nearest
  } else {
    f.normal = n / length;
    f.offset = f.normal.dot(a);
  }
  return face_count_++;
}

void Polytope::link(int f, int side, int g, int other_side) {
  faces_[size_t(f)].next[size_t(side)] = g;
  faces_[size_t(f)].next_side[size_t(side)] = other_side;
  faces_[size_t(g)].next[size_t(other_side)] = f;
  faces_[size_t(g)].next_side[size_t(other_side)] = side;
}

bool Polytope::start(const Simplex& s) {
  for (int i = 0; i < s.count; ++i) add_vertex(s.points[size_t(i)]);
  const auto flat = [&] { return 1e-13 * size_; };
  const auto vertex = [&](int i) -> const Vec3& { return vertices_[size_t(i)].w; };
  if (vertex_count_ == 1) {
    for (int k = 0; k < 6 && vertex_count_ == 1; ++k) {
      const Vec3 d = (k % 2 ? -1.0 : 1.0) * Vec3::Unit(k / 2);
      const DifferencePoint p = probe(d);
      if ((p.w - vertex(0)).norm() > std::max(flat(), 1e-13 * p.w.norm())) add_vertex(p);
    }
    if (vertex_count_ == 1) return false;
  }
  if (vertex_count_ == 2) {
    Vec3 d = vertex(1) - vertex(0), t1, t2;
    d.normalize();
    tangent_frame(d, t1, t2);
    for (const Vec3& n : {t1, Vec3(-t1), t2, Vec3(-t2)}) {
      const DifferencePoint p = probe(n);
      const Vec3 off = p.w - vertex(0);
      if ((off - d * d.dot(off)).norm() <= flat()) continue;
      add_vertex(p);
      break;
    }
    if (vertex_count_ == 2) return false;
  }
  if (vertex_count_ == 3) {
    Vec3 n = (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0));
    if (!(n.norm() > 0)) return false;
    n.normalize();
    const DifferencePoint up = probe(n), down = probe(-n);
    const double above = n.dot(up.w - vertex(0)), below = -n.dot(down.w - vertex(0));
    if (std::max(above, below) <= flat()) return false;
    add_vertex(above >= below ? up : down);
  }
  if ((vertex(1) - vertex(0)).dot((vertex(2) - vertex(0)).cross(vertex(3) - vertex(0))) > 0)
    std::swap(vertices_[1], vertices_[2]);
  // faces outward: the fourth vertex is below the first three
  const int f0 = add_face(0, 1, 2), f1 = add_face(0, 3, 1), f2 = add_face(1, 3, 2),
            f3 = add_face(2, 3, 0);
  link(f0, 0, f1, 2);
  link(f0, 1, f2, 2);
  link(f0, 2, f3, 2);
  link(f1, 1, f2, 0);
  link(f2, 1, f3, 0);
  link(f3, 1, f1, 0);
  return true;
}

int Polytope::nearest_face() const {
  int best = -1;
  for (int i = 0; i < face_count_; ++i) {
    const Face& f = faces_[size_t(i)];
    if (f.alive && (best < 0 || f.offset < faces_[size_t(best)].offset)) best = i;
  }
  return best;
}

/// Walks over the faces that see the new vertex, from `f` which was entered through `side`, and
/// closes the hole with a fan along its rim. False when rounding left no simple rim.
bool Polytope::grow(int f, int side, int vertex) {
  Face& face = faces_[size_t(f)];
  if (!face.alive) return true;
  // Faces in one plane with the vertex are taken in too: left standing they would make slivers.
  const bool visible = face.normal.isZero() || face.normal.dot(vertices_[size_t(vertex)].w) >
                                                   face.offset - coplanar * size_;
  if (!visible) {
    if (face_count_ == max_faces) return false;
    const int a = face.corner[size_t(side)], b = face.corner[size_t((side + 1) % 3)];
    const int g = add_face(b, a, vertex);  // runs against the side it closes
    link(g, 0, f, side);
    if (last_new_ >= 0) {
      if (faces_[size_t(last_new_)].corner[1] != b) return false;
      link(last_new_, 1, g, 2);  // the rim is walked in one direction
    } else {
      first_new_ = g;
    }
    last_new_ = g;
    return true;
  }
  face.alive = false;
  for (int k = 1; k < 3; ++k) {
    const int s = (side + k) % 3;
    if (!grow(face.next[size_t(s)], face.next_side[size_t(s)], vertex)) return false;
  }
  return true;
}

void Polytope::witness(const Face& f, EpaResult& r) const {
  // barycentric weights of the origin's projection
  const Vec3 o = f.normal * f.offset;
  const auto &p = vertices_[size_t(f.corner[0])], &q = vertices_[size_t(f.corner[1])],
             &s = vertices_[size_t(f.corner[2])];
  const double wp = f.normal.dot((q.w - o).cross(s.w - o)),
               wq = f.normal.dot((s.w - o).cross(p.w - o)),
               ws = f.normal.dot((p.w - o).cross(q.w - o));
  const double sum = wp + wq + ws;
  if (!(sum > 0)) return;
  r.a = (wp * p.a + wq * q.a + ws * s.a) / sum;
  r.b = (wp * p.b + wq * q.b + ws * s.b) / sum;
}

void Polytope::expand(EpaResult& r, double tolerance) {
  for (r.iterations = 1;; ++r.iterations) {
    const int nearest = nearest_face();
    if (nearest < 0 || !std::isfinite(faces_[size_t(nearest)].offset)) break;
    const Face face = faces_[size_t(nearest)];
    const DifferencePoint p = probe(face.normal);
    const double height = face.normal.dot(p.w);
    r.lower_bound = std::max(0.0, std::min(face.offset, best_depth_));
    witness(face, r);
    if (height - face.offset <= tolerance * best_depth_ + 1e-14 * size_) {
      r.converged = true;
      break;
    }
    bool known = false;
    for (int c : face.corner) known = known || vertices_[size_t(c)].w == p.w;
    if (known || vertex_count_ == max_vertices) break;
    const int v = add_vertex(p);
    faces_[size_t(nearest)].alive = false;
    first_new_ = last_new_ = -1;
    bool whole = true;
    for (size_t k = 0; k < 3 && whole; ++k) whole = grow(face.next[k], face.next_side[k], v);
    if (!whole || first_new_ < 0 || first_new_ == last_new_) break;
    const Face &first = faces_[size_t(first_new_)], &last = faces_[size_t(last_new_)];
    if (last.corner[1] != first.corner[0]) break;
    link(last_new_, 1, first_new_, 2);
  }
}

}  // namespace

EpaResult epa(const PlacedCore& A, const PlacedCore& B, const Simplex& start,
              double relative_tolerance) {
  EpaResult r;
  Polytope polytope(A, B);
  r.a = start.nearest_a();
  r.b = start.nearest_b();
  if (polytope.start(start)) {
    polytope.expand(r, relative_tolerance);
  } else {
    r.converged = true;
  }
  // A direction of the difference along which it reaches least: B moves that way.
  r.normal = polytope.best_normal();
  r.depth = polytope.best_depth();
  if (!std::isfinite(r.depth)) r.depth = 0;
  if (r.depth < 0) r.depth = 0;
  return r;
}

}  // namespace tumble
