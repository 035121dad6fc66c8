// Triangles of two surfaces that are near each other. Reference: brute force over all pairs by the
// closed-form nearest points of triangles. Small surfaces and large ones are searched in different
// ways, so both kinds meet both.
#include "engine/collision/mesh_pairs/near_triangles.hpp"

#include "engine/collision/mesh_pairs/mesh_surface.hpp"
#include "engine/collision/mesh_pairs/overlap_contours.hpp"
#include "engine/collision/mesh_pairs/small_surface.hpp"
#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/collision/support.hpp"

#include <algorithm>
#include <limits>

using namespace tumble;
using namespace tumble::test;

namespace {

std::array<Vec3, 3> corners(const PlacedSurface& S, uint32_t t) {
  const Triangle& ids = S.s.mesh->triangles[t];
  return {S.vertex(ids[0]), S.vertex(ids[1]), S.vertex(ids[2])};
}

PlacedSurface placed(const MeshSurface& s, const Pose& pose) {
  return {s, pose.q.toRotationMatrix(), pose.x};
}

MeshSurface surface(TriangleMesh m) {
  return build_mesh_surface(std::make_shared<const TriangleMesh>(std::move(m)));
}

/// A pyramid on a square: five vertices.
TriangleMesh odd_hull() {
  TriangleMesh m;
  m.vertices = {{0.3, 0, 0.3}, {0.3, 0, -0.3}, {-0.3, 0, -0.3}, {-0.3, 0, 0.3}, {0, 0.4, 0}};
  m.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 3, 2}, {0, 2, 1}};
  return m;
}

/// Checks one query against all pairs; the number of pairs within reach.
size_t check(const PlacedSurface& A, const PlacedSurface& B, double reach) {
  std::vector<TriangleIds> found, crossing, by_b, swapped;
  double apart = 0;
  REQUIRE(near_triangles(A, B, reach, std::numeric_limits<size_t>::max(), nullptr, found, &apart,
                         &crossing, &by_b));
  const auto before = [](const TriangleIds& x, const TriangleIds& y) {
    return std::pair(x.a, x.b) < std::pair(y.a, y.b);
  };
  CHECK(std::ranges::is_sorted(found, before));
  CHECK(std::ranges::is_sorted(crossing, before));
  for (const TriangleIds& x : found) swapped.push_back({x.b, x.a});
  std::ranges::sort(swapped, before);
  CHECK(std::ranges::equal(by_b, swapped, [](const TriangleIds& x, const TriangleIds& y) {
    return x.a == y.a && x.b == y.b;
  }));
  CHECK(std::ranges::includes(found, crossing, before));
  const double hair = 9e-7 * (A.s.size + B.s.size);  // whoever asks may move B by as much
  CHECK(apart >= reach);
  size_t within = 0;
  for (uint32_t a = 0; a < A.s.mesh->triangles.size(); ++a) {
    for (uint32_t b = 0; b < B.s.mesh->triangles.size(); ++b) {
      const TrianglePair near = closest_triangle_triangle(corners(A, a), corners(B, b));
      const double distance = std::sqrt(near.squared_distance);
      const bool listed = std::ranges::binary_search(found, TriangleIds{a, b}, before);
      if (distance <= reach - 1e-9) {
        ++within;
        CHECK(listed);
      }
      if (!listed) CHECK(distance > (found.empty() ? apart : reach) - 1e-9);
      if (distance <= std::min(hair, reach - 1e-9))
        CHECK(std::ranges::binary_search(crossing, TriangleIds{a, b}, before));
    }
  }
  return within;
}

}  // namespace

TEST_CASE("near triangles are those of brute force, of small surfaces and large ones alike") {
  std::vector<MeshSurface> surfaces;
  surfaces.push_back(surface(make_mesh::tetrahedron(0.5)));
  surfaces.push_back(surface(make_mesh::box({0.3, 0.2, 0.4})));
  surfaces.push_back(surface(make_mesh::torus(0.5, 0.2, 10, 6)));
  surfaces.push_back(surface(make_mesh::terrain(
      4, 8, [](double x, double z) { return 0.2 * det::sin(3 * x) * det::cos(2 * z); })));
  TriangleMesh part = make_mesh::box({0.3, 0.2, 0.1});  // with vertices of something else
  part.vertices.resize(500, Vec3(0, 3, 0));
  surfaces.push_back(surface(part));
  surfaces.push_back(surface(make_mesh::torus(0.4, 0.15, 8, 4)));  // 64 triangles
  surfaces.push_back(surface(odd_hull()));
  REQUIRE((is_small(surfaces[5]) && is_small(surfaces[6])));
  REQUIRE(surfaces[6].mesh->vertices.size() % 2 == 1);
  REQUIRE((is_small(surfaces[1]) && !is_small(surfaces[2]) && !is_small(surfaces[4])));
  Random r(4);
  size_t within = 0, queries = 0, without = 0;
  for (int i = 0; i < cases(12); ++i) {
    for (const MeshSurface& a : surfaces) {
      for (const MeshSurface& b : surfaces) {
        const Pose pa{random_vec(r, -5, 5), random_rotation(r)};
        const Pose pb{pa.x + r.uniform(0.1, 1.2) * random_direction(r), random_rotation(r)};
        const size_t here =
            check(placed(a, pa), placed(b, pb), r.uniform() < 0.3 ? 0 : r.uniform(0, 0.1));
        within += here;
        without += here == 0;
        ++queries;
      }
    }
  }
  CHECK(within > queries);
  CHECK(4 * without > queries);
}

TEST_CASE("the search for near triangles stops when there are too many") {
  const MeshSurface ball = surface(make_mesh::icosphere(0.5, 2));
  const MeshSurface box = surface(make_mesh::box({1, 1, 1}));
  const MeshSurface ring = surface(make_mesh::torus(0.5, 0.2, 16, 12));
  const Pose at{Vec3(0.9, 0, 0), Quat::Identity()};
  const auto stops = [](const PlacedSurface& A, const PlacedSurface& B) {
    std::vector<TriangleIds> found;
    CHECK_FALSE(near_triangles(A, B, 2, 50, nullptr, found));
    CHECK(found.size() < 1000);  // what one leaf adds, and not all there are
  };
  stops(placed(ball, at), placed(box, {}));
  stops(placed(box, {}), placed(ball, at));
  stops(placed(ball, at), placed(ring, {}));
}

TEST_CASE("contours are found among what may cross, also with one surface moved by a hair") {
  Random r(41);
  const MeshSurface cube = surface(make_mesh::box({0.3, 0.2, 0.25}));
  const MeshSurface ring = surface(make_mesh::torus(0.4, 0.12, 32, 16));
  size_t near = 0, kept = 0, crossings = 0;
  for (int k = 0; k < cases(300); ++k) {
    const MeshSurface &a = k % 2 ? ring : cube, &b = k % 4 < 2 ? cube : ring;
    Pose pose{random_vec(r, -0.5, 0.5), random_rotation(r)};
    const double hair = 9e-7 * (a.size + b.size);
    // Cubes face to face are as near as can be without certainty on which side they are.
    if (k % 4 == 0) pose = {{0.01, 0.4 + r.uniform(-1, 1) * hair, 0.02}, Quat::Identity()};
    const PlacedSurface A = placed(a, Pose{}), B = placed(b, pose);
    std::vector<TriangleIds> pairs, crossing;
    near_triangles(A, B, 0.02, 100000, nullptr, pairs, nullptr, &crossing);
    near += pairs.size();
    kept += crossing.size();
    const PlacedSurface moved{B.s, B.R, B.x + 0.5 * hair * random_vec(r, -1, 1)};
    OverlapContours all, few;
    find_contours(A, moved, pairs, all);
    find_contours(A, moved, crossing, few);
    crossings += all.nodes.size();
    REQUIRE(few.nodes.size() == all.nodes.size());
    for (size_t i = 0; i < all.nodes.size(); ++i) {
      CHECK(few.nodes[i].edge == all.nodes[i].edge);
      CHECK(few.nodes[i].triangle == all.nodes[i].triangle);
      CHECK(few.nodes[i].s == all.nodes[i].s);
    }
    CHECK(few.segments.size() == all.segments.size());
    CHECK(few.sound == all.sound);
  }
  if (near > 100) {
    CHECK(crossings > 0);
    CHECK(3 * kept < 2 * near);
  }
}
