// Contacts of boxes and hulls under the narrow phase "v_clip". References: GJK's distance; the
// contacts of the narrow phase "gjk"; the same query with the shapes exchanged or started
// elsewhere.
#include "engine/collision/gjk/gjk.hpp"
#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/shapes/convex_shape.hpp"
#include "tests/collision/support.hpp"

#include <limits>

using namespace tumble;
using namespace tumble::test;

namespace {

NarrowPhase phase(std::string_view name) {
  for (const NarrowPhaseEntry& e : all_narrow_phases())
    if (e.name == name) return e.collide;
  FAIL("no narrow phase of that name");
  return nullptr;
}

double least(const std::vector<Manifold>& list) {
  double gap = std::numeric_limits<double>::infinity();
  for (const Manifold& m : list)
    for (int i = 0; i < m.count; ++i) gap = std::min(gap, m.points[size_t(i)].gap);
  return gap;
}

std::vector<std::shared_ptr<const Shape>> polyhedra(Random& r) {
  return {box({0.3, 0.4, 0.5}), box({0.5, 0.02, 0.4}), random_hull(r, 6, {0.4, 0.5, 0.3}),
          random_hull(r, 40, {0.5, 0.3, 0.4}), random_hull(r, 300, {0.4, 0.4, 0.4})};
}

}  // namespace

TEST_CASE("v_clip finds the gap of polyhedra that are apart, and no contact beyond the margin") {
  Random r(71);
  const auto shapes = polyhedra(r);
  const NarrowPhase v_clip = phase("v_clip");
  const double margin = 0.1;
  const int n = cases(300);
  int near = 0, deep = 0;
  for (const auto& a : shapes)
    for (const auto& b : shapes)
      for (int i = 0; i < n; ++i) {
        const Pose pa{random_vec(r, -2, 2), random_rotation(r)};
        const Pose pb{pa.x + random_direction(r) * r.uniform(0, 1.4), random_rotation(r)};
        std::vector<Manifold> found;
        v_clip(*a, pa, *b, pb, margin, found);
        const GjkResult reference =
            gjk(PlacedCore(*a->convex(), pa.q, pa.x), PlacedCore(*b->convex(), pb.q, pb.x));
        if (reference.status == GjkStatus::intersecting) {
          ++deep;
          REQUIRE(!found.empty());
          CHECK(least(found) <= 0);
          continue;
        }
        REQUIRE(found.empty() == (reference.distance > margin));
        if (found.empty()) continue;
        ++near;
        CHECK(std::abs(least(found) - reference.distance) < 1e-9);
        CHECK((found[0].normal - reference.normal).norm() < 1e-6);
      }
  if (n >= 50) CHECK((near > 3 * n / 2 && deep > 3 * n / 2));
}

TEST_CASE("v_clip: contacts with the shapes exchanged are the same with opposite normals") {
  Random r(73);
  const auto shapes = polyhedra(r);
  const NarrowPhase v_clip = phase("v_clip");
  int compared = 0, differing = 0;
  for (const auto& a : shapes)
    for (const auto& b : shapes)
      for (int i = 0; i < cases(100); ++i) {
        const Pose pa{random_vec(r, -2, 2), random_rotation(r)};
        const Pose pb{pa.x + random_direction(r) * r.uniform(0.3, 1.2), random_rotation(r)};
        std::vector<Manifold> one, other;
        v_clip(*a, pa, *b, pb, 0.1, one);
        v_clip(*b, pb, *a, pa, 0.1, other);
        REQUIRE(one.size() == other.size());
        if (one.empty() || least(one) < 0) continue;
        CHECK(std::abs(least(one) - least(other)) < 1e-9);
        CHECK((one[0].normal + other[0].normal).norm() < 1e-6);
        ++compared;
        // which face is cut by which may matter to a corner at the very margin
        differing += one[0].count != other[0].count;
      }
  CHECK(differing <= 2 + compared / 100);
}

TEST_CASE("v_clip: where the search starts changes the answer by no more than rounding") {
  Random r(79);
  const auto shapes = polyhedra(r);
  const NarrowPhase v_clip = phase("v_clip");
  for (const auto& a : shapes)
    for (const auto& b : shapes)
      for (int i = 0; i < cases(40); ++i) {
        const Pose pa{random_vec(r, -2, 2), random_rotation(r)};
        Pose pb{pa.x + random_direction(r) * r.uniform(0.5, 1.0), random_rotation(r)};
        ClosestFeatures last{
            PolyhedronFeature{FeatureKind(r.uniform(0, 4)), uint32_t(r.uniform(0, 400))},
            PolyhedronFeature{FeatureKind(r.uniform(0, 4)), uint32_t(r.uniform(0, 400))}};
        for (int tick = 0; tick < 20; ++tick) {
          pb.x += 0.01 * random_direction(r);
          std::vector<Manifold> cold, warm;
          v_clip(*a, pa, *b, pb, 0.3, cold);
          ContactQuery query(0.3);
          query.start = &last;
          v_clip(*a, pa, *b, pb, query, warm);
          REQUIRE(cold.size() == warm.size());
          if (cold.empty()) break;
          last = warm[0].closest;
          if (least(cold) > 0) CHECK(std::abs(least(cold) - least(warm)) < 1e-12);
        }
      }
}

TEST_CASE("what is round is the same under every narrow phase") {
  Random r(83);
  const std::vector<std::shared_ptr<const Shape>> shapes{sphere(0.4), capsule(0.2, 0.6),
                                                         cylinder(0.3, 0.5), box({0.3, 0.3, 0.4})};
  for (const auto& a : shapes)
    for (const auto& b : shapes) {
      if (a->polyhedral() && b->polyhedral()) continue;
      for (int i = 0; i < 20; ++i) {
        const Pose pa{random_vec(r, -1, 1), random_rotation(r)};
        const Pose pb{pa.x + random_direction(r) * r.uniform(0, 1), random_rotation(r)};
        std::vector<Manifold> reference;
        phase("gjk")(*a, pa, *b, pb, 0.05, reference);
        for (const NarrowPhaseEntry& e : all_narrow_phases()) {
          std::vector<Manifold> found;
          e.collide(*a, pa, *b, pb, 0.05, found);
          REQUIRE(found.size() == reference.size());
          for (size_t k = 0; k < found.size(); ++k) {
            CHECK(found[k].normal == reference[k].normal);
            CHECK(least(found) == least(reference));
          }
        }
      }
    }
}
