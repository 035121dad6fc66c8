// The accuracy cases A1, A7 and A8 (tests/support/accuracy/cases.hpp) at 60 Hz with distance fields
// in place of the floor. References and bounds are those of the box that it is otherwise
// (accuracy_realtime_test.cpp).
#include "engine/geometry/make_mesh.hpp"
#include "tests/support/accuracy/cases.hpp"
#include "tests/support/accuracy/tumble_case.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

/// The floor as a field with its top where it was, so wide that nothing hangs over its edge: within
/// a cell of an edge normals lean.
void as_field(BodyDef& def) {
  if (def.type != BodyType::fixed) return;
  const Vec3 half(20, 0.5, 20);
  for (BodyShapeDef& s : def.shapes) {
    def.pose.x.y() += s.shape.half_extents.y() - half.y();
    s.shape.type = ShapeType::distance_field;
    s.shape.cell = 0.25;
    s.shape.mesh = std::make_shared<const TriangleMesh>(make_mesh::box(half));
  }
}

CaseMaker with_fields() {
  return tumble_maker(WorldSettings{},
                      {[](const std::string& message) { FAIL(message); }, {}, as_field});
}

Vec3 level_direction(double degrees) {
  const double a = degrees * M_PI / 180;
  return {std::cos(a), 0, std::sin(a)};
}

}  // namespace

TEST_CASE("a field for the floor: a slab slides under rolling balls as the closed form says (A1)") {
  for (const double degrees : {0.0, 60.0}) {
    CAPTURE(degrees);
    const RollingErrors e = a1_rolling(with_fields(), 60, level_direction(degrees), 4);
    CHECK(e.slab < 8.7e-4);
    CHECK(e.ball < 8.7e-4);
  }
}

TEST_CASE("a field for the floor: a block below the angle of friction stays where it is (A7)") {
  for (const double degrees : {0.0, 100.0}) {
    CAPTURE(degrees);
    const Slide held = a7_slide(with_fields(), 60, level_direction(degrees), 0.45, 5);
    CHECK(std::hypot(held.distance, held.across) < 7e-6);
    CHECK(a7_slide(with_fields(), 60, level_direction(degrees), 0.51, 2).distance > 0.01);
  }
}

TEST_CASE("a field for the floor: a box bears a thousand times its mass (A8)") {
  const SinkErrors e = a8_sink(with_fields(), 60, 1000);
  CHECK(e.most < 0.05);
  CHECK(e.speed < 1e-6);
}
