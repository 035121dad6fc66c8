// Cones and tapered capsules that lie on a plane and roll. References: closed forms of rolling
// about the point where the axis meets the plane (Landau & Lifshitz, Mechanics, 32, problem 7):
// with the half angle a and the centre of mass at D from that point, turning about the vertical at
// f' goes with the angular velocity f' cot a along the line of contact, about which the moment of
// inertia is I = I_axis cos^2 a + (I_across + m D^2) sin^2 a. On a plane that leans by b it is a
// pendulum: f'' = -w^2 sin f, w^2 = m g sin b D cos a tan^2 a / I.
#include "engine/math/rotation.hpp"
#include "tests/support/scale.hpp"
#include "tests/support/test_world.hpp"

#include <cmath>

using namespace tumble;
using test::TestWorld;

namespace {

/// As the closed forms know it: without resistance to turning.
void roll_freely(Material& material) {
  material.rolling_friction = 0;
  material.torsional_friction = 0;
}

constexpr double g = 9.81;

/// A body that tapers towards +y, lying on the plane y = 0 with its apex at the origin.
struct Rolling {
  ShapeDef shape;
  double half_angle = 0;  ///< a
  double apex = 0;        ///< of the side, on y of the shape's frame [m]
  double distance = 0;    ///< D [m]
  double frequency2 = 0;  ///< w^2 / (g sin b)

  explicit Rolling(const ShapeDef& def) : shape(def) {
    if (def.type == ShapeType::cone) {
      half_angle = std::atan(def.radius / def.height);
      apex = 0.5 * def.height;
    } else {
      const double taper = (def.radius - def.top_radius) / def.height;
      half_angle = std::asin(taper);
      apex = 0.5 * (def.radius + def.top_radius) / taper;
    }
    const auto solid = (*make_shape(def))->mass_properties();
    distance = apex - solid->centre.y();
    const double s = std::sin(half_angle), c = std::cos(half_angle);
    const double across = solid->inertia(0, 0) + solid->mass * distance * distance;
    const double inertia = solid->inertia(1, 1) * c * c + across * s * s;
    frequency2 = solid->mass * distance * c * s * s / (c * c) / inertia;
  }
  /// At the angle f about y, turning at `rate` [1/s].
  BodyDef body(double f, double rate, double friction) const {
    BodyDef def = TestWorld::shape_def(shape, Vec3::Zero());
    def.shapes[0].material.friction = friction;
    roll_freely(def.shapes[0].material);
    def.shapes[0].material.restitution = 0;
    def.pose.q = axis_angle(Vec3::UnitY(), f) * axis_angle(Vec3::UnitZ(), M_PI / 2 + half_angle);
    def.pose.x = -def.pose.direction(Vec3(0, apex, 0));
    const Vec3 along(std::cos(f), 0, -std::sin(f));
    def.angular_velocity = -rate / std::tan(half_angle) * along;
    def.velocity = -def.angular_velocity.cross(def.pose.direction(Vec3(0, distance, 0)));
    return def;
  }
  /// The angle about y of where a body lies.
  static double angle(const RigidBody& b) {
    const Vec3 from_apex = -b.pose.direction(Vec3::UnitY());
    return std::atan2(-from_apex.z(), from_apex.x());
  }
};

std::vector<Rolling> rolling_bodies() {
  return {
      Rolling({.type = ShapeType::cone, .radius = 0.1, .height = 0.3}),
      Rolling({.type = ShapeType::cone, .radius = 0.2, .height = 0.25}),
      Rolling(
          {.type = ShapeType::tapered_capsule, .radius = 0.12, .height = 0.3, .top_radius = 0.05})};
}

WorldSettings settings(std::string_view stepper, double slope) {
  WorldSettings s;
  s.stepper = stepper;
  s.tick.num = 240;
  s.gravity = {g * std::sin(slope), -g * std::cos(slope), 0};
  return s;
}

void add_ground(TestWorld& w, double friction) {
  BodyDef ground =
      TestWorld::shape_def({.type = ShapeType::half_space}, Vec3::Zero(), BodyType::fixed);
  ground.shapes[0].material.friction = friction;
  roll_freely(ground.shapes[0].material);
  ground.shapes[0].material.restitution = 0;
  w.add(ground);
}

double turned_by(double from, double to) {
  return std::remainder(to - from, 2 * M_PI);
}

}  // namespace

TEST_CASE("what tapers rolls round in a circle, evenly, and keeps its energy" *
          doctest::test_suite("long")) {
  for (const std::string_view stepper : {"event", "realtime"}) {
    CAPTURE(stepper);
    const bool exact = stepper == "event";
    for (const Rolling& r : rolling_bodies()) {
      CAPTURE(r.half_angle);
      TestWorld w(settings(stepper, 0));
      add_ground(w, 1);
      const double rate = 1.5;
      const BodyId id = w.add(r.body(0, rate, 1));
      const RigidBody& b = w.body(id);
      const double height = b.pose.x.y();
      const Vec3 middle(0, height, 0);
      const double way = (b.pose.x - middle).norm();
      CHECK(height == doctest::Approx(r.distance * std::sin(r.half_angle)));
      double worst = 0;
      for (int k = 1; k <= 2 * 240; ++k) {
        w.step();
        const RigidBody& now = w.body(id);
        worst = std::max(worst, std::fabs(turned_by(rate * k / 240, Rolling::angle(now))));
        CHECK(std::fabs(now.pose.x.y() - height) < (exact ? 1e-7 : 2e-4));
        CHECK(std::fabs((now.pose.x - middle).norm() - way) < (exact ? 1e-5 : 0.02 * way));
      }
      MESSAGE(std::string(stepper), ": a turn of 3 rad is off by ", worst, " rad");
      CHECK(worst < (exact ? 1e-8 : 0.03));
    }
  }
}

TEST_CASE("what tapers swings on a slope like a pendulum") {
  const double slope = 5 * M_PI / 180, start = 0.5;
  const int ticks = test::only_to_run() ? 30 : 2 * 240;
  for (const std::string_view stepper : {"event", "realtime"}) {
    CAPTURE(stepper);
    const bool exact = stepper == "event";
    for (const Rolling& r : rolling_bodies()) {
      CAPTURE(r.half_angle);
      TestWorld w(settings(stepper, slope));
      add_ground(w, 2);
      const BodyId id = w.add(r.body(start, 0, 2));
      // f'' = -w^2 sin f by a fourth order scheme of small steps.
      const double w2 = r.frequency2 * g * std::sin(slope), h = 1.0 / 2400;
      double f = start, rate = 0, worst = 0;
      for (int k = 1; k <= ticks; ++k) {
        w.step();
        for (int step = 0; step < 10; ++step) {
          const auto a = [&](double x) { return -w2 * std::sin(x); };
          const double k1 = a(f), k2 = a(f + 0.5 * h * rate),
                       k3 = a(f + 0.5 * h * rate + 0.25 * h * h * k1),
                       k4 = a(f + h * rate + 0.5 * h * h * k2);
          f += h * rate + h * h / 6 * (k1 + k2 + k3);
          rate += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
        }
        worst = std::max(worst, std::fabs(turned_by(f, Rolling::angle(w.body(id)))));
      }
      MESSAGE(std::string(stepper), ": angle of the pendulum off by ", worst, " of ", start);
      CHECK(worst < (exact ? 1e-8 : 0.02));
    }
  }
}

TEST_CASE("a cone stands on a slope up to tan b = 4 r / h, and tips over beyond") {
  // The centre of mass is h/4 above the base; down the slope is a point of the rim that contacts
  // take.
  const double radius = 0.1, height = 0.5, limit = std::atan(4 * radius / height);
  for (const std::string_view stepper : {"event", "realtime"})
    for (const double share : {0.97, 1.03}) {
      CAPTURE(stepper);
      CAPTURE(share);
      TestWorld w(settings(stepper, share * limit));
      add_ground(w, 3);
      BodyDef def = TestWorld::shape_def(
          {.type = ShapeType::cone, .radius = radius, .height = height}, {0, 0.5 * height, 0});
      def.shapes[0].material.friction = 3;
      const BodyId id = w.add(def);
      w.run(2);
      const double up = w.body(id).pose.direction(Vec3::UnitY()).y();
      if (share < 1)
        CHECK(up > 0.9999);
      else
        CHECK(up < 0.9);
    }
}
