#include "engine/geometry/hierarchy/brute_force.hpp"

namespace tumble {
namespace {

/// Calls visit(ids, corners of a, corners of b) for all pairs, ascending, until it returns false.
template <class Visit>
void each_pair(const TriangleMesh& ma, const TriangleMesh& mb, const Pose& b_in_a,
               HierarchyStatistics* cost, const Visit& visit) {
  const RelativePose at(b_in_a);
  size_t tests = 0;
  const auto all = [&] {
    for (uint32_t a = 0; a < ma.triangles.size(); ++a) {
      const TriangleCorners own = corners(ma, a);
      for (uint32_t b = 0; b < mb.triangles.size(); ++b) {
        ++tests;
        if (!visit(TriangleIds{a, b}, own, corners(mb, b, at))) return;
      }
    }
  };
  all();
  if (cost) cost->triangle_tests += tests;
}

}  // namespace

void BruteForceHierarchy::overlap(const Aabb& box, std::vector<uint32_t>& out) const {
  for (uint32_t t = 0; t < mesh_->triangles.size(); ++t) {
    if (triangle_meets_box(*mesh_, t, box)) out.push_back(t);
  }
}

std::optional<MeshRayHit> BruteForceHierarchy::ray(const Ray& ray, double t_max) const {
  const RayShear shear(ray);
  std::optional<MeshRayHit> best;
  for (uint32_t t = 0; t < mesh_->triangles.size(); ++t) {
    const auto hit =
        shear.triangle(mesh_->corner(t, 0), mesh_->corner(t, 1), mesh_->corner(t, 2), t_max);
    if (!hit || (best && hit->t >= best->t)) continue;
    best = MeshRayHit{hit->t, t, hit->barycentric, hit->front};
  }
  return best;
}

std::optional<MeshPoint> BruteForceHierarchy::closest(const Vec3& p, double max_distance) const {
  std::optional<MeshPoint> best;
  const double limit = max_distance * max_distance;
  for (uint32_t t = 0; t < mesh_->triangles.size(); ++t) {
    const TrianglePoint near =
        closest_on_triangle(p, mesh_->corner(t, 0), mesh_->corner(t, 1), mesh_->corner(t, 2));
    if (!(near.squared_distance <= limit)) continue;
    if (best && near.squared_distance >= best->squared_distance) continue;
    best = MeshPoint{near.point, t, near.barycentric, near.feature, near.squared_distance};
  }
  return best;
}

void BruteForceHierarchy::pairs(const Hierarchy& other, const Pose& other_pose, double margin,
                                std::vector<TriangleIds>& out, HierarchyStatistics* cost) const {
  each_pair(*mesh_, other.mesh(), other_pose, cost, [&](auto ids, const auto& a, const auto& b) {
    if (triangles_near(a, b, margin)) out.push_back(ids);
    return true;
  });
}

bool BruteForceHierarchy::intersects(const Hierarchy& other, const Pose& other_pose,
                                     HierarchyStatistics* cost) const {
  bool found = false;
  each_pair(*mesh_, other.mesh(), other_pose, cost, [&](auto, const auto& a, const auto& b) {
    found = triangles_meet(a, b);
    return !found;
  });
  return found;
}

void BruteForceHierarchy::self_pairs(double margin, std::vector<TriangleIds>& out,
                                     HierarchyStatistics* cost) const {
  each_pair(*mesh_, *mesh_, {}, cost, [&](auto ids, const auto& a, const auto& b) {
    if (ids.a < ids.b && !neighbours(*mesh_, ids.a, ids.b) && triangles_near(a, b, margin)) {
      out.push_back(ids);
    }
    return true;
  });
}

std::optional<MeshDistance> BruteForceHierarchy::distance(const Hierarchy& other,
                                                          const Pose& other_pose,
                                                          double max_distance,
                                                          HierarchyStatistics* cost) const {
  std::optional<MeshDistance> best;
  const double limit = max_distance * max_distance;
  each_pair(*mesh_, other.mesh(), other_pose, cost, [&](auto ids, const auto& a, const auto& b) {
    const TrianglePair near = closest_triangle_triangle(a, b);
    if (near.squared_distance <= limit &&
        (!best || near.squared_distance < best->squared_distance)) {
      best = MeshDistance{ids, near.on_a, near.on_b, near.squared_distance};
    }
    return true;
  });
  return best;
}

void BruteForceHierarchy::swept_pairs(const Hierarchy& other, const SweptQuery& query,
                                      std::vector<TriangleIds>& out,
                                      HierarchyStatistics* cost) const {
  const Vec3 sweep = query.other_motion.translation - query.own.translation;
  each_pair(*mesh_, other.mesh(), query.other_pose, cost,
            [&](auto ids, const auto& a, const auto& b) {
              const double reach =
                  query.margin + turned_reach(a, query.own) + turned_reach(b, query.other_motion);
              if (swept_triangles_near(a, b, sweep, reach)) out.push_back(ids);
              return true;
            });
}

}  // namespace tumble
