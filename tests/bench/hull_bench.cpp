// Convex hulls against Qhull (its default options Qt: triangulated, merged where needed) and CGAL
// (exact predicates): points in a ball, on a sphere and in a cube. The answer is the number of
// hull vertices.
#include "engine/core/random.hpp"
#include "engine/geometry/hull/convex_hull.hpp"
#include "tests/bench/contest.hpp"
#include "tests/geometry/draws.hpp"
#include "tests/geometry/qhull_peer.hpp"

#include <cmath>
#include <cstdlib>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

using namespace tumble;

namespace {

using Points = std::vector<Vec3>;

Points in_ball(uint32_t n) {
  Random random(1);
  Points out;
  for (uint32_t i = 0; i < n; ++i) {
    const Vec3 d = draws::direction(random);
    out.push_back(d * std::cbrt(random.uniform()));
  }
  return out;
}

Points on_sphere(uint32_t n) {
  Random random(2);
  Points out;
  for (uint32_t i = 0; i < n; ++i) out.push_back(draws::direction(random));
  return out;
}

Points in_cube(uint32_t n) {
  Random random(3);
  return draws::points(random, n);
}

double ours(const Points& points) {
  return double(convex_hull(points)->polyhedron.vertices.size());
}

double qhull(const Points& points) {
  return double(peers::qhull(points, "Pp", false).vertices.size());
}

double cgal(const std::vector<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>& p) {
  CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3> hull;
  CGAL::convex_hull_3(p.begin(), p.end(), hull);
  return double(hull.number_of_vertices());
}

}  // namespace

int main(int argc, char** argv) {
  const uint32_t most = argc > 1 ? uint32_t(std::atoi(argv[1])) : 1000000;
  struct Family {
    const char* name;
    Points (*draw)(uint32_t);
  };
  for (const Family& family : {Family{"ball", in_ball}, {"sphere", on_sphere}, {"cube", in_cube}}) {
    for (uint32_t n = 1000; n <= most; n *= 10) {
      const Points points = family.draw(n);
      std::vector<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3> same;
      for (const Vec3& p : points) same.emplace_back(p.x(), p.y(), p.z());
      bench::report(std::string("hull of ") + std::to_string(n) + " points, " + family.name,
                    {{"Qhull", [&] { return qhull(points); }},
                     {"CGAL", [&] { return cgal(same); }},
                     {"tumble", [&] { return ours(points); }}},
                    n > 100000 ? 3 : 7);
    }
  }
}
