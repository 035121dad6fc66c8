#pragma once
// Scenes of many bodies that several tests share.
#include "engine/core/random.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/rigid_world.hpp"
#include "tests/support/scale.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace tumble::test {

/// `full` times TUMBLE_TEST_SCALE, at least `least`.
inline int scaled(int full, int least) {
  return std::clamp(int(full * scale()), std::min(least, full), full);
}

inline ShapeDef random_hull(Random& random, int points, double radius) {
  TriangleMesh cloud;
  for (int k = 0; k < points; ++k) {
    Vec3 v;
    do {
      v = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    } while (v.norm() > 1 || v.norm() < 0.1);
    cloud.vertices.push_back(radius * v.normalized());
  }
  return hull(std::move(cloud));
}

/// A floor between four walls.
inline void add_walls(RigidWorld& w) {
  w.floor();
  for (const double side : {-1.0, 1.0}) {
    w.fixed(box(0.5, 10, 5), {side * 4.5, 10, 0});
    w.fixed(box(5, 10, 0.5), {0, 10, side * 4.5});
  }
}

/// Boxes, spheres, capsules, cylinders and hulls above a floor between four walls.
inline void add_mixed_pile(RigidWorld& w, int count, uint64_t seed = 3) {
  add_walls(w);
  Random r(seed);
  for (int i = 0; i < count; ++i) {
    const Vec3 x{(i % 6 - 2.5) * 1.1 + r.uniform(-.1, .1), 1 + 1.1 * (i / 36),
                 (i / 6 % 6 - 2.5) * 1.1 + r.uniform(-.1, .1)};
    ShapeDef shape;
    switch (i % 5) {
      case 0:
        shape = box(.4, .3, .25);
        break;
      case 1:
        shape = sphere(.35);
        break;
      case 2:
        shape = capsule(.25, .4);
        break;
      case 3:
        shape = cylinder(.3, .5);
        break;
      default:
        shape = random_hull(r, 14, 0.42);
    }
    BodyDef d = body(std::move(shape), x);
    const Vec3 axis{r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1)};
    d.pose.q = axis_angle(axis, r.uniform(0, 3));
    w.add(d);
  }
}

/// The card house of the accuracy case A9: cards lean by 25 degrees, friction 0.7.
inline void add_card_house(RigidWorld& w, int levels) {
  w.floor(0.7);
  const double a = 25 * M_PI / 180, length = 0.2, thick = 0.005, spacing = 0.36;
  const double reach = length * std::sin(a) + thick * std::cos(a);
  const double rise = length * std::cos(a) + thick * std::sin(a);
  const auto card = [&](const Vec3& half, const Vec3& x, double angle) {
    BodyDef d = body(box(half.x(), half.y(), half.z()), x, 0.7);
    d.shapes[0].material.density = 500;
    d.pose.q = axis_angle(Vec3::UnitZ(), angle);
    w.add(d);
  };
  double y = 0;
  for (int level = 0; level < levels; ++level) {
    const int n = levels - level;
    const double x0 = -(n - 1) * spacing / 2;
    for (int i = 0; i < n; ++i) {
      for (const double side : {-1.0, 1.0}) {
        card({thick, length, .15}, {x0 + i * spacing + side * reach, y + rise, 0}, side * a);
      }
    }
    y += 2 * rise;
    for (int i = 0; i + 1 < n; ++i) {
      card({spacing / 2 - .002, thick, .15}, {x0 + (i + .5) * spacing, y + thick, 0}, 0);
    }
    y += 2 * thick;
  }
}

/// A semicircular arch of wedges between radii 2 and 2.6, without mortar.
inline void add_arch(RigidWorld& w, int stones) {
  w.floor(0.7);
  for (int i = 0; i < stones; ++i) {
    TriangleMesh wedge;
    for (const double z : {-0.4, 0.4}) {
      for (const double angle : {M_PI * i / stones, M_PI * (i + 1) / stones}) {
        for (const double r : {2.0, 2.6}) {
          wedge.vertices.push_back({r * std::cos(angle), r * std::sin(angle), z});
        }
      }
    }
    w.add(body(hull(std::move(wedge)), Vec3::Zero(), 0.7));
  }
}

/// Greatest distance of any body from where it was.
inline double displacement(const RigidWorld& w, const std::vector<RigidBody>& start) {
  double most = 0;
  for (size_t i = 0; i < start.size(); ++i) {
    most = std::max(most, (w.bodies[i].pose.x - start[i].pose.x).norm());
  }
  return most;
}

}  // namespace tumble::test
