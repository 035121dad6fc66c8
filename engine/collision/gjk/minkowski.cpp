#include "engine/collision/gjk/minkowski.hpp"

#include <cmath>

namespace tumble {

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
