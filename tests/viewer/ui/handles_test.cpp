// Reference: points that are displaced by hand and projected into the picture; what a body weighs
// before and after it has grown.
#include "viewer/interact/handles.hpp"

#include "engine/collision/shape.hpp"
#include "engine/math/rotation.hpp"
#include "tests/support/test_world.hpp"
#include "viewer/app/editing/displaced_body.hpp"

#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;
using Part = Handles::Part;

namespace {

Handles::View looking_from(const Vec3& eye) {
  Camera camera;
  camera.eye = eye;
  camera.target = Vec3(0, 1, 0);
  return {camera, 1280, 800};
}

const Pose frame{Vec3(0.3, 1.2, -0.4), axis_angle(Vec3(1, 2, -1).normalized(), 0.7)};

/// What a pointer asks that goes from a grip to where that point of space is to be.
std::optional<Displacement> dragged(HandleKind kind, Part part, const Handles::View& view,
                                    const Vec3& to, bool snap = false) {
  HandleSettings settings;
  settings.kind = kind;
  settings.own_axes = true;
  const Vec3 from =
      project(view.camera, Handles::grip(kind, frame, part, view), view.width, view.height);
  CHECK(Handles::hit(kind, frame, view, from.x(), from.y()) == part);
  Handles handles;
  handles.begin(settings, frame, part, view, from.x(), from.y());
  const Vec3 end = project(view.camera, to, view.width, view.height);
  return handles.drag(view, end.x(), end.y(), snap);
}

}  // namespace

TEST_CASE("arms and squares move what is dragged to the point under the pointer") {
  for (const Vec3& eye : {Vec3(6, 4, 8), Vec3(-3, 2, 5), Vec3(40, 30, 60)}) {
    const Handles::View view = looking_from(eye);
    const Vec3 shifts[] = {Vec3(0.7, 0, 0), Vec3(0, 0.4, 0), Vec3(0, 0, -0.9)};
    const Part arms[] = {Part::x, Part::y, Part::z};
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 shift = frame.direction(shifts[axis]);
      const Vec3 grip = Handles::grip(HandleKind::move, frame, arms[axis], view);
      const auto way = dragged(HandleKind::move, arms[axis], view, grip + shift);
      REQUIRE(way);
      CHECK((way->shift - shift).norm() < 1e-9);
      CHECK((way->moved(Pose{}).x - shift).norm() < 1e-9);
    }
    const Vec3 across = frame.direction(Vec3(0.5, 0, 0.2));
    const Vec3 grip = Handles::grip(HandleKind::move, frame, Part::across_y, view);
    const auto way = dragged(HandleKind::move, Part::across_y, view, grip + across);
    REQUIRE(way);
    CHECK((way->shift - across).norm() < 1e-9);
    // In steps of .1 m along the frame's axes.
    const auto snapped = dragged(HandleKind::move, Part::across_y, view,
                                 grip + frame.direction(Vec3(0.53, 0, 0.17)), true);
    REQUIRE(snapped);
    CHECK((snapped->shift - across).norm() < 1e-9);
  }
}

TEST_CASE("along the world's axes bodies snap to places on a grid, and only where they move") {
  const Pose at{Vec3(0.3003, 1.2207, -0.4001), Quat::Identity()};
  const Handles::View view = looking_from(Vec3(6, 4, 8));
  HandleSettings settings;
  settings.kind = HandleKind::move;
  const auto ends_at = [&](Part part, const Vec3& shift) {
    const Vec3 grip = Handles::grip(HandleKind::move, at, part, view);
    const Vec3 from = project(view.camera, grip, view.width, view.height);
    const Vec3 to = project(view.camera, grip + shift, view.width, view.height);
    Handles handles;
    handles.begin(settings, at, part, view, from.x(), from.y());
    const auto way = handles.drag(view, to.x(), to.y(), true);
    REQUIRE(way);
    return way->moved(at).x;
  };
  CHECK((ends_at(Part::x, Vec3(0.52, 0, 0)) - Vec3(0.8, 1.2207, -0.4001)).norm() < 1e-12);
  CHECK((ends_at(Part::across_y, Vec3(0.52, 0, 0.33)) - Vec3(0.8, 1.2207, -0.1)).norm() < 1e-12);
}

TEST_CASE("a displacement by nothing changes no bit of a pose") {
  const Pose pose{Vec3(0.1, 0.7, -1.0 / 3), axis_angle(Vec3(1, 2, -1).normalized(), 0.7)};
  Displacement way{.pivot = Vec3(7, 1.0 / 3, 1e3)};
  CHECK(way.is_null());
  Pose uneven = pose;
  uneven.q.coeffs() *= 1 + 3e-16;  // as normalising would change it
  CHECK(way.moved(uneven).x == uneven.x);
  CHECK(way.moved(uneven).q.coeffs() == uneven.q.coeffs());
  way.shift = Vec3(1, 0, 0);
  CHECK_FALSE(way.is_null());
  CHECK(way.moved(uneven).q.coeffs() == uneven.q.coeffs());
  CHECK_FALSE(Displacement{.turn = axis_angle(Vec3::UnitX(), 1e-9)}.is_null());
  CHECK_FALSE(Displacement{.scale = 1.1}.is_null());
}

TEST_CASE("rings turn about their axis, seen from the side too") {
  const double angle = 0.6;
  const Part rings[] = {Part::x, Part::y, Part::z};
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 n = frame.direction(Vec3::Unit(axis));
    for (const double lean : {0.8, 0.3}) {
      const Vec3 aside = frame.direction(Vec3::Unit((axis + 1) % 3));
      const Handles::View view = looking_from(
          frame.x + 7 * (std::sin(lean) * n + std::cos(lean) * aside) + Vec3(0, 0.1, 0));
      const Vec3 grip = Handles::grip(HandleKind::turn, frame, rings[axis], view);
      const Vec3 to = frame.x + axis_angle(n, angle) * (grip - frame.x);
      const Vec3 from = project(view.camera, grip, view.width, view.height);
      HandleSettings settings;
      settings.kind = HandleKind::turn;
      Handles handles;
      handles.begin(settings, frame, rings[axis], view, from.x(), from.y());
      const Vec3 end = project(view.camera, to, view.width, view.height);
      const auto way = handles.drag(view, end.x(), end.y(), false);
      REQUIRE(way);
      CHECK(way->turn.angularDistance(axis_angle(n, angle)) < 1e-6);
      const auto snapped = handles.drag(view, end.x(), end.y(), true);  // 34.4 degrees
      CHECK(snapped->turn.angularDistance(axis_angle(n, 30 * std::numbers::pi / 180)) < 1e-6);
      // The pivot stays.
      CHECK((way->moved(frame).x - frame.x).norm() < 1e-12);
    }
  }
}

TEST_CASE("handles have one size in pixels, near and far") {
  for (const double distance : {2.0, 10.0, 300.0}) {
    const Handles::View view = looking_from(frame.x + distance * Vec3(0.5, 0.3, 0.8));
    const Vec3 a = project(view.camera, frame.x, view.width, view.height);
    double longest = 0;
    for (const Part part : {Part::x, Part::y, Part::z}) {
      const Vec3 b = project(view.camera, Handles::grip(HandleKind::move, frame, part, view),
                             view.width, view.height);
      longest = std::max(longest, (b - a).head<2>().norm());
    }
    CHECK(longest > 40);
    CHECK(longest < 90);
  }
}

TEST_CASE("a body that grows has the mass and the places of a larger one") {
  BodyDef def = TestWorld::box_def({1, 2, 3});
  BodyShapeDef ball;
  ball.shape.type = ShapeType::sphere;
  ball.shape.radius = 0.3;
  ball.pose.x = Vec3(0.5, 0.5, 0);
  def.shapes.push_back(ball);
  def.pose.q = axis_angle(Vec3::UnitZ(), std::numbers::pi / 2);
  Displacement way;
  way.pivot = Vec3(0, 2, 3);
  way.scale = 2;
  auto grown = displaced(def, way);
  REQUIRE(grown.ok());
  CHECK((grown->pose.x - Vec3(2, 2, 3)).norm() < 1e-12);
  CHECK((grown->shapes[0].shape.half_extents - 2 * def.shapes[0].shape.half_extents).norm() <
        1e-12);
  CHECK(grown->shapes[1].shape.radius == doctest::Approx(0.6));
  CHECK((grown->shapes[1].pose.x - Vec3(1, 1, 0)).norm() < 1e-12);
  TestWorld w;
  const BodyId small = w.add(def), large = w.add(*grown);
  CHECK(w->body(large)->mass == doctest::Approx(8 * w->body(small)->mass));
  // Along the world's y, which is the box's x.
  way.scale_axis = Vec3::UnitY();
  grown = displaced(def, way);
  REQUIRE(grown.ok());
  const Vec3 expected = def.shapes[0].shape.half_extents.cwiseProduct(Vec3(2, 1, 1));
  CHECK((grown->shapes[0].shape.half_extents - expected).norm() < 1e-12);
  CHECK((grown->shapes[1].pose.x - Vec3(1, 0.5, 0)).norm() < 1e-12);
  def.inertia = Vec3(1, 1, 1);
  CHECK_FALSE(displaced(def, way).ok());
  way.scale_axis.reset();
  CHECK((*displaced(def, way)->inertia - Vec3(4, 4, 4)).norm() < 1e-12);
}
