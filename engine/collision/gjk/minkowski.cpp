#include "engine/collision/gjk/minkowski.hpp"

#include <cmath>

namespace tumble {

Difference::Difference(const PlacedCore& A, const PlacedCore& B) : A_(A), a_(*A.core), b_(*B.core) {
  const auto column = [](const Mat3& m, int k) -> Plain3 {
    const double* c = m.data() + 3 * k;
    return {c[0], c[1], c[2]};
  };
  const Plain3 b0 = column(B.R, 0), b1 = column(B.R, 1), b2 = column(B.R, 2);
  const Plain3 x{B.x.x() - A.x.x(), B.x.y() - A.x.y(), B.x.z() - A.x.z()};
  const auto row = [&](const Plain3& a) -> Plain3 { return {a.dot(b0), a.dot(b1), a.dot(b2)}; };
  const Plain3 a0 = column(A.R, 0), a1 = column(A.R, 1), a2 = column(A.R, 2);
  R_ = {row(a0), row(a1), row(a2)};
  t_ = {a0.dot(x), a1.dot(x), a2.dot(x)};
  scale_ = a_.view.reach + b_.view.reach + std::sqrt(t_.squared());
  if (b_.view.kind == CoreView::Kind::vertices && b_.view.vertices.padded <= most_few) bring_few();
}

/// The same operations as from_b() on two vertices at a time.
void Difference::bring_few() {
  const VertexCloudView& v = b_.view.vertices;
  double* out = few_coordinates_.data();
  few_ = {out, out + most_few, out + 2 * most_few, v.padded, nullptr};
  const auto coordinate = [&](const Plain3& row, double t, double* to) {
    const __m128d x = _mm_set1_pd(row.x), y = _mm_set1_pd(row.y), z = _mm_set1_pd(row.z),
                  shift = _mm_set1_pd(t);
    for (uint32_t i = 0; i < v.padded; i += 2)
      _mm_store_pd(to + i, _mm_add_pd(FourHeights::two(v, i, x, y, z), shift));
  };
  coordinate(R_.row0, t_.x, out);
  coordinate(R_.row1, t_.y, out + most_few);
  coordinate(R_.row2, t_.z, out + 2 * most_few);
}

bool Difference::Side::vertex(uint32_t k, Plain3& p) const {
  if (view.kind == CoreView::Kind::box && k < 8) {
    const Vec3& h = view.half;
    p = {k & 1 ? h.x() : -h.x(), k & 2 ? h.y() : -h.y(), k & 4 ? h.z() : -h.z()};
    return true;
  }
  if (view.kind != CoreView::Kind::vertices || k >= view.vertices.padded) return false;
  p = view.vertices[k];
  return true;
}

bool Difference::recall(uint32_t vertex_a, uint32_t vertex_b, DifferencePoint& p) const {
  Plain3 b;
  if (!a_.vertex(vertex_a, p.a) || !b_.vertex(vertex_b, b)) return false;
  p.b = from_b(b);
  p.w = p.a - p.b;
  p.vertex_a = vertex_a;
  p.vertex_b = vertex_b;
  return true;
}

}  // namespace tumble
