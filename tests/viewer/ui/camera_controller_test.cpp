// Reference: closed forms of pinhole projection, through the renderer's own project().
#include "viewer/interact/camera_controller.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

Camera start_camera() {
  Camera c;
  c.eye = Vec3(3, 4, 9);
  c.target = Vec3(1, 1, -2);
  c.fov_deg = 50;
  return c;
}

double distance(const Camera& c) {
  return (c.eye - c.target).norm();
}

}  // namespace

TEST_CASE("a camera taken over is given back") {
  CameraController controller;
  controller.set(start_camera());
  CHECK((controller.camera().eye - Vec3(3, 4, 9)).norm() < 1e-12);
  CHECK((controller.camera().target - Vec3(1, 1, -2)).norm() < 1e-12);
  CHECK(controller.camera().fov_deg == 50);
}

TEST_CASE("orbiting keeps the pivot and the distance, and never turns over") {
  CameraController controller;
  controller.set(start_camera());
  const double before = distance(controller.camera());
  for (int i = 0; i < 50; ++i) {
    controller.orbit(37 * std::sin(i), 90 * std::cos(0.3 * i));
    controller.arrive();
    CHECK((controller.camera().target - Vec3(1, 1, -2)).norm() < 1e-9);
    CHECK(std::abs(distance(controller.camera()) - before) < 1e-9);
    const Vec3 view = (controller.camera().target - controller.camera().eye).normalized();
    CHECK(std::abs(view.y()) < 0.99985);  // 89 degrees
  }
  controller.orbit(0, 1e6);
  controller.arrive();
  CHECK(controller.camera().eye.y() > controller.camera().target.y());
}

TEST_CASE("dragging to the right turns the scene to the right") {
  CameraController controller;
  Camera c;
  c.eye = Vec3(0, 0, 10);
  c.target = Vec3::Zero();
  controller.set(c);
  const Vec3 front(0, 0, 1);  // a point on the near side
  const double before = project(controller.camera(), front, 800, 600).x();
  controller.orbit(60, 0);
  controller.arrive();
  CHECK(project(controller.camera(), front, 800, 600).x() > before);
}

TEST_CASE("panning moves the pivot's plane with the pointer, pixel by pixel") {
  CameraController controller;
  controller.set(start_camera());
  const Vec3 point = controller.camera().target;
  const Vec3 before = project(controller.camera(), point, 1000, 700);
  controller.pan(120, -45, 700);
  controller.arrive();
  const Vec3 after = project(controller.camera(), point, 1000, 700);
  CHECK(after.x() - before.x() == doctest::Approx(120).epsilon(1e-6));
  CHECK(after.y() - before.y() == doctest::Approx(-45).epsilon(1e-6));
}

TEST_CASE("zooming multiplies the distance and there and back is nothing") {
  CameraController controller;
  controller.set(start_camera());
  const double before = distance(controller.camera());
  controller.zoom(3);
  controller.arrive();
  CHECK(distance(controller.camera()) < 0.75 * before);
  controller.zoom(-3);
  controller.arrive();
  CHECK(distance(controller.camera()) == doctest::Approx(before));
  for (int i = 0; i < 500; ++i) controller.zoom(10);
  controller.arrive();
  CHECK(distance(controller.camera()) > 0.01);
}

TEST_CASE("looking around keeps the eye, flying forward goes where one looks") {
  CameraController controller;
  controller.set(start_camera());
  const Vec3 eye = controller.camera().eye;
  controller.look(140, -60);
  controller.arrive();
  CHECK((controller.camera().eye - eye).norm() < 1e-9);
  const Vec3 view = (controller.camera().target - controller.camera().eye).normalized();
  controller.fly(Vec3(0, 0, 1), 0.1, false);
  controller.arrive();
  const Vec3 moved = controller.camera().eye - eye;
  CHECK(moved.norm() > 0.01);
  CHECK(moved.normalized().dot(view) == doctest::Approx(1));
}

TEST_CASE("focus on a point puts it in the middle and keeps the eye, on bounds shows them all") {
  CameraController controller;
  controller.set(start_camera());
  const Vec3 eye = controller.camera().eye, point(4, 0.5, 1);
  controller.focus(point);
  for (int i = 0; i < 120; ++i) controller.update(1.0 / 60);
  CHECK((controller.camera().eye - eye).norm() < 1e-3);
  const Vec3 at = project(controller.camera(), point, 800, 600);
  CHECK(at.x() == doctest::Approx(400).epsilon(1e-3));
  CHECK(at.y() == doctest::Approx(300).epsilon(1e-3));

  Aabb box;
  box.include(Vec3(-3, 0, -1));
  box.include(Vec3(5, 2, 4));
  controller.focus(box, 800.0 / 600);
  controller.arrive();
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 x((corner & 1) ? box.max.x() : box.min.x(), (corner & 2) ? box.max.y() : box.min.y(),
                 (corner & 4) ? box.max.z() : box.min.z());
    const Vec3 p = project(controller.camera(), x, 800, 600);
    CHECK(p.z() > 0);
    CHECK(p.x() > 0);
    CHECK(p.x() < 800);
    CHECK(p.y() > 0);
    CHECK(p.y() < 600);
  }
}

TEST_CASE("following the goal does not depend on the frame rate") {
  CameraController slow, fast;
  slow.set(start_camera());
  fast.set(start_camera());
  slow.orbit(200, 50);
  fast.orbit(200, 50);
  slow.zoom(2);
  fast.zoom(2);
  for (int i = 0; i < 6; ++i) slow.update(1.0 / 30);
  for (int i = 0; i < 24; ++i) fast.update(1.0 / 120);
  CHECK((slow.camera().eye - fast.camera().eye).norm() < 1e-9);
}

TEST_CASE("the eye stays above the floor, whatever a person does, unless the scene put it below") {
  constexpr double floor = 0.5;
  CameraController controller;
  controller.set(start_camera());
  const auto height = [&] {
    controller.arrive();
    return controller.camera().eye.y();
  };
  controller.set_floor(floor);
  controller.orbit(30, -1e5);
  CHECK(height() > floor);
  CHECK(height() < floor + 0.02 * distance(controller.camera()));  // as low as may be
  CHECK((controller.camera().target - Vec3(1, 1, -2)).norm() < 1e-9);
  controller.zoom(-40);
  CHECK(height() > floor);
  controller.zoom(40);
  controller.pan(0, -1e5, 700);
  CHECK(height() > floor);
  CHECK(controller.camera().target.y() >= floor);
  controller.set(start_camera());
  controller.set_floor(floor);
  controller.look(0, -300);  // up: the eye does not move
  CHECK(height() == doctest::Approx(4));
  controller.fly(Vec3(0, -1, 0), 10, true);
  CHECK(height() == doctest::Approx(floor));

  Camera below = start_camera();
  below.eye.y() = -3;
  controller.set(below);
  controller.set_floor(floor);
  controller.orbit(30, -10);
  CHECK(height() < floor);
}

TEST_CASE("going to a camera ends there, by the shorter way around") {
  CameraController controller;
  controller.set(start_camera());
  controller.orbit(2500, 40);  // twice around and more
  controller.arrive();
  Camera goal;
  goal.eye = Vec3(-4, 3, 5);
  goal.target = Vec3(0, 1, 1);
  goal.fov_deg = 30;
  controller.go_to(goal);
  const Vec3 before = controller.camera().eye;
  double longest = 0;
  for (int i = 0; i < 200; ++i) {
    controller.update(0.01);
    longest = std::max(longest, (controller.camera().eye - before).norm());
  }
  CHECK((controller.camera().eye - goal.eye).norm() < 1e-6);
  CHECK((controller.camera().target - goal.target).norm() < 1e-6);
  CHECK(controller.camera().fov_deg == 30);
  CHECK(longest < 1.01 * (goal.eye - before).norm());
}

TEST_CASE("a narrower picture shows as much from left to right, and its rays are its own") {
  const Camera wide = start_camera();
  const double ratio = 4.25, width = 320, height = 720;
  const Camera narrow = heightened(wide, ratio);
  CHECK(heightened(wide, 1).fov_deg == wide.fov_deg);
  CHECK(std::tan(narrow.fov_deg * M_PI / 360) ==
        doctest::Approx(ratio * std::tan(wide.fov_deg * M_PI / 360)));
  for (const Vec3& x : {Vec3(1, 1, -2), Vec3(-3, 2, 0), Vec3(4, -1, 2)}) {
    const Vec3 a = project(wide, x, ratio * width, height);
    const Vec3 b = project(narrow, x, width, height);
    CHECK(b.x() / width == doctest::Approx(a.x() / (ratio * width)));
    CHECK(b.y() / height - 0.5 == doctest::Approx((a.y() / height - 0.5) / ratio));
    const Ray ray = pixel_ray(narrow, b.x(), b.y(), width, height);
    CHECK(ray.direction.cross(x - ray.origin).norm() < 1e-9);
  }
  // A point of the pivot's plane stays under the pointer that pans it.
  CameraController controller;
  controller.set(wide);
  controller.set_heightening(ratio);
  const double before = project(controller.seen(), wide.target, width, height).x();
  controller.pan(50, 0, height);
  controller.arrive();
  CHECK(project(controller.seen(), wide.target, width, height).x() - before == doctest::Approx(50));
  CHECK(controller.camera().fov_deg == wide.fov_deg);
}
