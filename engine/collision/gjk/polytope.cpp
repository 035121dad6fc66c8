#include "engine/collision/gjk/polytope.hpp"

#include "engine/collision/gjk/precise3.hpp"

#include <cmath>
#include <limits>

#include <emmintrin.h>

namespace tumble {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Error of a normal from a cross product, in units of |e1| |e2| / |e1 x e2|.
constexpr double cross_rounding = 1e-15;
/// Above this ratio the normal is computed in double-double arithmetic.
constexpr double sliver = 64;

}  // namespace

int Polytope::add_face(int i, int j, int k) {
  if (free_count_ == 0 && face_count_ == max_faces) return -1;
  const int index = free_count_ > 0 ? free_[size_t(--free_count_)] : face_count_++;
  offset_[size_t(face_count_)] = infinity;  // nearest_face() reads two at a time
  const Plain3 &a = vertices_[size_t(i)].w, &b = vertices_[size_t(j)].w,
               &c = vertices_[size_t(k)].w;
  Face& f = faces_[size_t(index)];
  f.corner = {i, j, k};
  f.alive = true;
  f.tilt = cross_rounding;
  const Plain3 u = b - a, v = c - a;
  Plain3 n = u.cross(v);
  double n2 = n.squared();
  const double uv = u.squared() * v.squared();
  if (uv > sliver * sliver * n2) {
    const Precise3 p = precise_normal(a, b, c);
    n = {p.x.high, p.y.high, p.z.high};
    n2 = n.squared();
  } else {
    f.tilt *= std::sqrt(uv / n2);
  }
  if (n2 > 0) {
    f.normal = n * (1 / std::sqrt(n2));
    offset_[size_t(index)] = f.normal.dot(a);
  } else {
    f.normal = {0, 0, 0};  // corners in one line: seen by all, never the nearest
    offset_[size_t(index)] = infinity;
  }
  return index;
}

void Polytope::link(int f, int side, int g, int other_side) {
  faces_[size_t(f)].next[size_t(side)] = g;
  faces_[size_t(f)].next_side[size_t(side)] = other_side;
  faces_[size_t(g)].next[size_t(other_side)] = f;
  faces_[size_t(g)].next_side[size_t(other_side)] = side;
}

bool Polytope::start(const std::array<DifferencePoint, 4>& points) {
  for (size_t i = 0; i < 4; ++i) vertices_[i] = points[i];
  vertex_count_ = 4;
  const double volume = precise_volume(points[0].w, points[1].w, points[2].w, points[3].w);
  if (volume == 0) return false;
  if (volume > 0) std::swap(vertices_[1], vertices_[2]);
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

bool Polytope::sees(const Face& f, const Plain3& p) const {
  const Plain3& a = vertices_[size_t(f.corner[0])].w;
  const Plain3 d = p - a;
  const double height = f.normal.dot(d);
  if (height * height > f.tilt * f.tilt * d.squared()) return height > 0;
  return precise_volume(a, vertices_[size_t(f.corner[1])].w, vertices_[size_t(f.corner[2])].w, p) >=
         0;
}

void Polytope::kill(int f) {
  faces_[size_t(f)].alive = false;
  offset_[size_t(f)] = infinity;
  dying_[size_t(dying_count_++)] = f;
}

/// Traverses the faces that see the new vertex, from `f`, which was entered through `side`, and
/// adds a fan along the horizon.
bool Polytope::grow(int f, int side, int vertex) {
  const Face& face = faces_[size_t(f)];
  if (!face.alive) return true;
  if (sees(face, vertices_[size_t(vertex)].w)) {
    kill(f);
    for (int k = 1; k < 3; ++k) {
      const auto s = size_t((side + k) % 3);
      if (!grow(face.next[s], face.next_side[s], vertex)) return false;
    }
    return true;
  }
  const int a = face.corner[size_t(side)], b = face.corner[size_t((side + 1) % 3)];
  const int g = add_face(b, a, vertex);  // opposite to the side that it closes
  if (g < 0) return false;
  link(g, 0, f, side);
  if (last_new_ >= 0) {
    if (faces_[size_t(last_new_)].corner[1] != b) return false;
    link(last_new_, 1, g, 2);  // the horizon is traversed in one direction
  } else {
    first_new_ = g;
  }
  last_new_ = g;
  return true;
}

bool Polytope::add(const DifferencePoint& p, int seen) {
  if (vertex_count_ == max_vertices) return false;
  const int v = vertex_count_++;
  vertices_[size_t(v)] = p;
  first_new_ = last_new_ = -1;
  dying_count_ = 0;
  kill(seen);
  const Face& start = faces_[size_t(seen)];
  for (size_t k = 0; k < 3; ++k)
    if (!grow(start.next[k], start.next_side[k], v)) return false;
  if (first_new_ < 0 || first_new_ == last_new_) return false;
  if (faces_[size_t(last_new_)].corner[1] != faces_[size_t(first_new_)].corner[0]) return false;
  link(last_new_, 1, first_new_, 2);
  // their places become free only now that nothing refers to them
  for (int i = 0; i < dying_count_; ++i) free_[size_t(free_count_++)] = dying_[size_t(i)];
  return true;
}

int Polytope::nearest_face() const {
  const double* o = offset_.data();
  __m128d m = _mm_load_pd(o);
  for (int i = 2; i < face_count_; i += 2) m = _mm_min_pd(m, _mm_load_pd(o + i));
  m = _mm_min_pd(m, _mm_shuffle_pd(m, m, 1));
  for (int i = 0; i < face_count_; i += 2) {
    const int bits = _mm_movemask_pd(_mm_cmpeq_pd(_mm_load_pd(o + i), m));
    if (bits) return i + (bits == 2);
  }
  return 0;
}

}  // namespace tumble
