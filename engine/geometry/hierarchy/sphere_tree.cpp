#include "engine/geometry/hierarchy/sphere_tree.hpp"

#include "engine/geometry/hierarchy/bounding_tree_distance.hpp"
#include "engine/geometry/hierarchy/bounding_tree_pairs.hpp"
#include "engine/geometry/hierarchy/bounding_tree_queries.hpp"
#include "engine/geometry/hierarchy/minimal_sphere.hpp"

namespace tumble {

template class BoundingTree<SphereKind>;

void SphereKind::fit(const FitInput& in, std::vector<TreeNode<SphereVolume>>& nodes) {
  std::vector<Vec3> points;
  points.reserve(3 * in.order.size());
  for (uint32_t t : in.order) {
    for (size_t k = 0; k < 3; ++k) points.push_back(in.mesh.corner(t, k) - in.origin);
  }
  const auto store = [&](uint32_t i, NodeRange range) {
    const std::span<const Vec3> own(points.data() + 3 * range.first,
                                    3 * (range.last - range.first));
    const Sphere s = minimal_sphere(own);
    SphereVolume& v = nodes[i];
    const auto nearby = to_float4(s.centre).array();
    std::copy_n(nearby.begin(), 3, v.centre.begin());
    // The radius is computed about the rounded centre, and rounded up.
    const Vec3 rounded = centre(v);
    double square = 0;
    for (const Vec3& p : own) square = std::max(square, (p - rounded).squaredNorm());
    const double radius = std::sqrt(square) * (1 + 1e-15);
    v.radius = std::nextafter(float(radius), std::numeric_limits<float>::infinity());
  };
  fit_upwards(nodes, store, store);
}

}  // namespace tumble
