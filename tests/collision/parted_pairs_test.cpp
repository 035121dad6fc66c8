// What is found apart, and how far. References: supports of both shapes along the normal, places by
// hand.
#include "engine/collision/gjk/gjk.hpp"
#include "engine/collision/mesh_pairs/mesh_surface.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/collision/pair_run.hpp"

using namespace tumble;
using namespace tumble::test;

TEST_CASE("meshes that are found apart are at least as far apart as it is said to be") {
  // Reference: the nearest of all pairs of triangles.
  Random r(33);
  const std::vector<std::shared_ptr<const Shape>> shapes{
      box({0.3, 0.4, 0.5}), random_hull(r, 20, {0.4, 0.5, 0.3}),
      mesh(make_mesh::torus(0.5, 0.15, 8, 6)), mesh(make_mesh::torus(0.3, 0.1, 16, 8))};
  const double margin = 0.01;
  int apart = 0, more = 0;
  const auto corners = [](const MeshSurface& s, const Pose& pose, uint32_t t) {
    std::array<Vec3, 3> out;
    for (size_t k = 0; k < 3; ++k) out[k] = pose.point(s.mesh->corner(t, k));
    return out;
  };
  for (const auto& a : shapes)
    for (const auto& b : shapes) {
      if (a->type() != ShapeType::triangle_mesh && b->type() != ShapeType::triangle_mesh) continue;
      for (int i = 0; i < cases(40); ++i) {
        const Pose pa{random_vec(r, -2, 2), random_rotation(r)};
        const Pose pb{pa.x + random_direction(r) * r.uniform(0.4, 1.3), random_rotation(r)};
        const auto said = said_apart(collide, *a, pa, *b, pb, margin);
        if (!said) continue;
        const MeshSurface &sa = a->polyhedral()->surface(), &sb = b->polyhedral()->surface();
        double distance = std::numeric_limits<double>::infinity();
        for (uint32_t t = 0; t < sa.mesh->triangles.size(); ++t)
          for (uint32_t u = 0; u < sb.mesh->triangles.size(); ++u) {
            const ClosestPair near =
                closest_triangle_triangle(corners(sa, pa, t), corners(sb, pb, u));
            distance = std::min(distance, (near.on_a - near.on_b).norm());
          }
        CHECK(*said <= std::max(distance, margin));
        CHECK(*said >= margin);
        ++apart;
        more += *said > 2 * margin;
      }
    }
  if (cases(40) < 40) return;
  CHECK(apart > 20);
  CHECK(more > 0.5 * apart);
}

TEST_CASE("what is found apart is at least as far apart as it is said to be") {
  Random r(19);
  const std::vector<std::shared_ptr<const Shape>> shapes{box({0.3, 0.4, 0.5}),
                                                         box({2, 0.02, 0.4}),
                                                         random_hull(r, 8, {0.4, 0.5, 0.3}),
                                                         sphere(0.4),
                                                         capsule(0.2, 0.6),
                                                         random_hull(r, 60, {0.5, 0.3, 0.4}),
                                                         cylinder(0.3, 0.5),
                                                         ellipsoid({0.2, 0.3, 0.5}),
                                                         cone(0.3, 0.6),
                                                         tapered_capsule(0.3, 0.1, 0.4)};
  const double margin = 0.02;
  int apart = 0, more = 0;
  double share = 0;
  for (const NarrowPhaseEntry& phase : all_narrow_phases())
    for (const auto& a : shapes)
      for (const auto& b : shapes)
        for (int i = 0; i < cases(100); ++i) {
          const Pose pa{random_vec(r, -2, 2), random_rotation(r)};
          const Pose pb{pa.x + random_direction(r) * r.uniform(0.5, 3), random_rotation(r)};
          const auto said = said_apart(phase.collide, *a, pa, *b, pb, margin);
          if (!said) continue;
          const PlacedCore A(*a->convex(), pa.q, pa.x), B(*b->convex(), pb.q, pb.x);
          const double distance = gjk(A, B).distance - A.core->rounding() - B.core->rounding();
          CHECK(*said <= distance);
          CHECK(*said >= margin);
          const bool boxes = a->type() == ShapeType::box && b->type() == ShapeType::box;
          if (phase.name != "gjk" || !boxes) continue;
          ++apart;
          more += *said > margin;
          share += *said / distance;
        }
  CHECK(more > 0.99 * apart);
  CHECK(share > 0.7 * apart);
  // far along an axis the bound is the distance
  const Pose above{{0.1, 0.6 + 0.25, 0.2}, Quat::Identity()};
  const auto below_box = [&](const std::shared_ptr<const Shape>& below) {
    return said_apart(collide, *below, {}, *box({0.4, 0.3, 0.4}), above, margin).value_or(-1);
  };
  CHECK(below_box(box({0.5, 0.3, 0.5})) == doctest::Approx(0.25).epsilon(1e-12));
  CHECK(below_box(half_space()) == doctest::Approx(0.55).epsilon(1e-12));
}
