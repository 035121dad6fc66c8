// References: a scan of all vertices, in the same arithmetic, whose answer is to be met vertex by
// vertex wherever heights differ by more than rounding.
#include "engine/collision/shapes/vertex_cloud.hpp"
#include "tests/collision/support.hpp"

#include <string>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

struct CloudFamily {
  std::string name;
  Vec3 axes;
  bool lattice;
};

std::vector<Vec3> draw_cloud(Random& r, const CloudFamily& family, int n) {
  std::vector<Vec3> out;
  for (int i = 0; i < n; ++i) {
    Vec3 v = random_direction(r);
    if (family.lattice) v = (4 * v).array().round() / 4;
    out.push_back(v.cwiseProduct(family.axes));
  }
  return out;
}

/// The first of the greatest, by plain arithmetic.
uint32_t first_furthest(const std::vector<Vec3>& vertices, const Plain3& d) {
  uint32_t best = 0;
  double height = -std::numeric_limits<double>::infinity();
  for (uint32_t i = 0; i < vertices.size(); ++i) {
    const double h = Plain3::of(vertices[i]).dot(d);
    if (h > height) height = h, best = i;
  }
  return best;
}

}  // namespace

TEST_CASE("tables and scans find the first of the furthest vertices, of few and many") {
  Random r(61);
  const std::array<CloudFamily, 5> families{CloudFamily{"ball", {1, 0.7, 1.3}, false},
                                            {"plate", {1, 1, 1e-4}, false},
                                            {"needle", {1, 1e-4, 1e-4}, false},
                                            {"lattice", {1, 1, 1}, true},
                                            {"far smaller", {1e-6, 1e-6, 1e-6}, false}};
  for (const CloudFamily& family : families) {
    CAPTURE(family.name);
    for (const int n : {1, 4, 5, 8, 9, 16, 17, 40, 64, 65, 200, 1500}) {
      CAPTURE(n);
      const std::vector<Vec3> vertices = draw_cloud(r, family, n);
      const VertexCloud cloud(vertices);
      const SupportTable table(vertices);
      int wrong = 0;
      for (int i = 0; i < cases(400); ++i) {
        Vec3 d = random_direction(r);
        if (i % 4 == 1) d = random_vec(r, -2, 2).array().round();  // borders of cells
        if (i % 4 == 2) d = d.cwiseQuotient(family.axes);          // where needles have corners
        if (i % 4 == 3) d *= std::pow(10.0, r.uniform(-30, 30));
        if (d.isZero()) continue;
        const Plain3 p = Plain3::of(d);
        const uint32_t expected = first_furthest(vertices, p);
        wrong += furthest_vertex(cloud.view(), p) != expected;
        wrong += table.furthest(p) != expected;
      }
      CHECK(wrong == 0);
    }
  }
}

TEST_CASE("directions that are not finite have some vertex") {
  Random r(62);
  const std::vector<Vec3> vertices = draw_cloud(r, {"ball", {1, 1, 1}, false}, 100);
  const SupportTable table(vertices);
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (const double bad : {inf, -inf, nan, 1e308, -1e308, 1e-320}) {
    CHECK(table.furthest({bad, 0, 1}) < 100);
    CHECK(table.furthest({0, bad, bad}) < 100);
    CHECK(table.furthest({1, 1, bad}) < 100);
    CHECK(table.furthest({bad, bad, bad}) < 100);
  }
}
