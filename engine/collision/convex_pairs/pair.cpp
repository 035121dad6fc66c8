#include "engine/collision/convex_pairs/pair.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Whether all points of a manifold are about equally near: other points of the surface will then
/// not touch soon.
bool level(const Manifold& m) {
  constexpr double share = 2e-3;  // of its size
  double least = m.points[0].gap, most = least, reach2 = 0;
  for (int i = 1; i < m.count; ++i) {
    const ManifoldPoint& p = m.points[size_t(i)];
    least = std::min(least, p.gap);
    most = std::max(most, p.gap);
    reach2 = std::max(reach2, (p.x_world - m.points[0].x_world).squaredNorm());
  }
  const double spread = most - least;
  return spread * spread <= share * share * reach2;
}

}  // namespace

void emit_nearest(const ShapePair& pair, std::vector<ManifoldPoint>& points, const Vec3& normal,
                  uint64_t part, std::vector<Manifold>& out) {
  for (const uint64_t which : {uint64_t{0}, second_manifold}) {
    if (points.empty() || (which != 0 && level(out.back()))) return;
    Manifold& m = out.emplace_back();
    reduce_points(points, normal, pair.kept, m);
    m.part = part + which;
    std::erase_if(points, [&](const ManifoldPoint& p) {
      for (int i = 0; i < m.count; ++i)
        if (m.points[size_t(i)].feature == p.feature) return true;
      return false;
    });
    for (int i = 0; i < m.count; ++i) m.points[size_t(i)].x_world += pair.origin;
  }
}

}  // namespace tumble
