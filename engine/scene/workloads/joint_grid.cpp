#include "engine/scene/workloads/definitions.hpp"
#include "engine/scene/workloads/parts.hpp"

namespace tumble {

/// W5: balls of 1 kg in a square, alternately raised and lowered, each joined to its neighbours at
/// the midpoints between them; the corners are fixed, and none collide.
Workload joint_grid_workload(bool small) {
  const int side = small ? 10 : 30;
  const double middle = (side - 1) / 2.0;
  Workload w;
  w.steps = 600;
  w.collides = false;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const double y = (i + j) % 2 == 0 ? 0.3 : -0.3;
      BodyDef ball = sphere_body({0.8 * (i - middle), y, 0.8 * (j - middle)}, 0.4);
      ball.mass = 1;
      ball.group = 1;
      const bool corner = (i == 0 || i == side - 1) && (j == 0 || j == side - 1);
      if (corner) ball.type = BodyType::fixed;
      w.bodies.push_back(std::move(ball));
    }
  }
  const auto join = [&w](size_t a, size_t b) {
    const Vec3 anchor = 0.5 * (w.bodies[a].pose.x + w.bodies[b].pose.x);
    w.joints.push_back({JointKind::spherical, a, b, {anchor, Quat::Identity()}});
  };
  const auto n = size_t(side);
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) {
      const size_t at = i * n + j;
      if (i + 1 < n) join(at, at + n);
      if (j + 1 < n) join(at, at + 1);
    }
  }
  return w;
}

}  // namespace tumble
