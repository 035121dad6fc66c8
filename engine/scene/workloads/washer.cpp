#include "engine/math/rotation.hpp"
#include "engine/scene/workloads/definitions.hpp"
#include "engine/scene/workloads/draws.hpp"
#include "engine/scene/workloads/parts.hpp"

namespace tumble {
namespace {

/// A hollow prism of sixteen walls about the z axis with two square lids, that turns about z.
BodyDef drum(double apothem, double half_length) {
  const int walls = 16;
  BodyDef def;
  def.type = BodyType::kinematic;
  def.angular_velocity = {0, 0, 0.5};
  const double half_angle = det::pi / walls;
  const double tangent = det::sin(half_angle) / det::cos(half_angle);
  for (int k = 0; k < walls; ++k) {
    const double a = 2 * half_angle * k;
    const Vec3 x = (apothem + 0.5) * Vec3(det::cos(a), det::sin(a), 0);
    def.shapes.push_back({box_shape({0.5, (apothem + 1) * tangent, half_length}),
                          {x, axis_angle(Vec3::UnitZ(), a)},
                          {}});
  }
  for (const double side : {-1.0, 1.0})
    def.shapes.push_back({box_shape({apothem + 1, apothem + 1, 0.5}),
                          {{0, 0, side * (half_length + 0.5)}, Quat::Identity()},
                          {}});
  return def;
}

}  // namespace

/// W8: a block of cubes in a kinematic drum.
Workload washer_workload(bool small) {
  const int side = small ? 5 : 10;
  const double middle = (side - 1) / 2.0;
  Workload w;
  w.steps = 600;
  w.bodies.push_back(drum(0.8 * side, 0.5 * side));
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (int k = 0; k < side; ++k)
        w.bodies.push_back(
            box_body(0.8 * Vec3(i - middle, j - middle, k - middle), Vec3::Constant(0.3)));
  return w;
}

}  // namespace tumble
