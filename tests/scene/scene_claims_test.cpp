// What the shipped scenes claim to show, as numbers. References: statics (an arch and a card house
// within their friction cones stand still), Coulomb's law (slides if mu < tan of the slope), the
// geometry of interlocked rings, conservation of energy, and "nothing passes a closed wall".
#include "engine/world/world.hpp"
#include "tests/scene/shipped_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

double greatest_speed(const BuiltScene& scene) {
  double speed = 0;
  for_each_moving(
      scene, [&](const RigidBody& b, const std::string&) { speed = std::max(speed, b.v.norm()); });
  return speed;
}

CoordinateFrame coordinate(const BuiltScene& scene, const std::string& joint,
                           std::string_view name) {
  const JointId id = scene.joints.at(joint);
  const auto frame = scene.world->frame();
  for (const JointFrame& j : *frame->joints)
    if (j.id == id) return *j.coordinate(name);
  FAIL("there is no such joint");
  return {};
}

}  // namespace

TEST_CASE("arch: stands for 10 s while balls drop on it") {
  BuiltScene s = shipped("arch");
  const Vec3 before = place(s, "keystone");
  run(s, 10);
  CHECK((place(s, "keystone") - before).norm() < 0.01);
  for (int i = 0; i < 13; ++i)
    if (i != 6) CHECK(place(s, copy("stone", i)).y() > 1.1);
}

TEST_CASE("pendulums: energy stays, the conical one keeps its circle, the double ones part") {
  BuiltScene s = shipped("pendulums");
  const double start = s.world->frame()->stats.energies.total();
  const double height = place(s, "bob").y();
  run(s, 10);
  CHECK(s.world->frame()->stats.energies.total() == doctest::Approx(start).epsilon(1e-4));
  CHECK(place(s, "bob").y() == doctest::Approx(height).epsilon(1e-4));
  CHECK((place(s, "lower0") - place(s, "lower2")).head<2>().norm() > 0.1);
  for (const JointFrame& j : *s.world->frame()->joints) {
    const double apart = (j.frame_b.x - j.frame_a.x).norm();
    CHECK(std::fabs(apart - (j.kind == JointKind::distance ? 2.2 : 0)) < 1e-3);
  }
}

TEST_CASE("door: the closer shuts it, and the ball leaves swing doors in the middle") {
  BuiltScene s = shipped("door");
  double widest = 0;
  for (int i = 0; i < 120; ++i) {
    run(s, 0.1);
    widest = std::max(widest, coordinate(s, "closer", "angle").value);
  }
  CHECK(widest > 1);
  CHECK(widest < 100 * std::numbers::pi / 180 + 1e-6);
  CHECK(std::fabs(coordinate(s, "closer", "angle").value) < 1e-3);
  for (const char* hinge : {"hinge_left", "hinge_right"})
    CHECK(std::fabs(coordinate(s, hinge, "angle").value) < 0.05);
  CHECK(place(s, "ball").z() < -2);
}

TEST_CASE(
    "crane: the jib turns at its rate, the trolley is where its motor wants it, the rope holds") {
  BuiltScene s = shipped("crane");
  for (int i = 0; i < 25; ++i) {
    run(s, 1);
    CHECK(coordinate(s, "rope", "length").value < 3.15 + 1e-4);
  }
  CHECK(coordinate(s, "slew", "angle").rate == doctest::Approx(0.35).epsilon(1e-3));
  CHECK(coordinate(s, "slew", "angle").value > std::numbers::pi);
  CHECK(coordinate(s, "rail", "position").value == doctest::Approx(2.8).epsilon(0.1));
}

TEST_CASE("ragdoll_stairs: no joint bends farther than it may, and all come to the floor") {
  BuiltScene s = shipped("ragdoll_stairs");
  double beyond = 0;
  for (int i = 0; i < 160; ++i) {
    run(s, 0.05);
    for (const JointFrame& j : *s.world->frame()->joints) {
      const JointDef& def = *s.world->joint(j.id);
      for (size_t k = 0; k < most_coordinates; ++k) {
        const CoordinateLimits& limits = def.drives[k].limits;
        const double value = j.coordinates[k].value;
        beyond = std::max({beyond, limits.lower - value, value - limits.upper});
      }
    }
  }
  // .10 to .134 rad in 31 runs whose gravity differs by 1e-5 each: in the one tick in which a
  // ragdoll lands on its head, with 9 kN in its neck.
  CHECK(beyond < 0.15);
  for (int i = 0; i < 3; ++i) CHECK(place(s, copy("head", i)).y() < 1.8);
}

TEST_CASE("joints: all kinds that hold something move for 20 s and stay together") {
  BuiltScene s = shipped("joints");
  std::vector<JointKind> kinds;
  for (const JointFrame& j : *s.world->frame()->joints) kinds.push_back(j.kind);
  for (const JointKindEntry& e : all_joint_kinds())
    if (!e.parts.empty()) CHECK_MESSAGE(std::count(kinds.begin(), kinds.end(), e.kind) > 0, e.name);
  run(s, 20);
  for_each_moving(s, [&](const RigidBody& b, const std::string& name) {
    CHECK_MESSAGE(b.v.norm() + 0.1 * b.omega.norm() > 0.02, name);
  });
  for (const JointFrame& j : *s.world->frame()->joints) {
    const Vec3 apart = j.frame_a.inverse_direction(j.frame_b.x - j.frame_a.x);
    const bool slides = j.kind == JointKind::cylindrical || j.kind == JointKind::prismatic;
    if (slides) CHECK(apart.head<2>().norm() < 1e-4);
    if (j.kind == JointKind::planar) CHECK(std::fabs(apart.z()) < 1e-4);
    if (j.kind == JointKind::revolute || j.kind == JointKind::spherical ||
        j.kind == JointKind::universal || j.kind == JointKind::rigid)
      CHECK_MESSAGE(apart.norm() < 1e-3, j.name);
  }
}

TEST_CASE("card_house: no card moves by more than a millimetre or two in 10 s") {
  BuiltScene s = shipped("card_house");
  std::map<std::string, Vec3> before;
  for_each_moving(s, [&](const RigidBody& b, const std::string& name) { before[name] = b.pose.x; });
  run(s, 10);
  for (const auto& card : before) {
    const std::string& name = card.first;
    if (name != "marble") CHECK_MESSAGE((place(s, name) - card.second).norm() < 0.002, name);
  }
}

TEST_CASE("tower: stands until the ball arrives, and not after") {
  BuiltScene s = shipped("tower");
  const Vec3 before = place(s, "merlon[0]");
  run(s, 1);
  CHECK((place(s, "merlon[0]") - before).norm() < 0.02);
  run(s, 3);
  int fallen = 0;
  for (int i = 0; i < 7; ++i) fallen += place(s, copy("merlon", i)).y() < before.y() - 0.5;
  CHECK(fallen >= 4);
}

TEST_CASE("friction_ramp: a block slides if and only if its friction is below the slope") {
  BuiltScene s = shipped("friction_ramp");
  std::vector<Vec3> before;
  for (int i = 0; i < 9; ++i) before.push_back(place(s, copy("block", i)));
  run(s, 6);
  const double limit = std::tan(25 * 3.14159265358979 / 180);
  for (int i = 0; i < 9; ++i) {
    const double mu = 0.1 * (i + 1),
                 moved = (place(s, copy("block", i)) - before[size_t(i)]).norm();
    CAPTURE(mu);
    if (mu < limit)
      CHECK(moved > 3);
    else
      CHECK(moved < 0.005);
  }
}

TEST_CASE("rolling_friction: balls roll out, rest on slopes and stop spinning as the values say") {
  for (const char* stepper : {"realtime", "event"}) {
    CAPTURE(stepper);
    BuiltScene s = shipped("rolling_friction", {std::string("settings.stepper=") + stepper});
    const double g = 9.81, r = 0.2, speed = 1.4, rho[6] = {0, 0.005, 0.01, 0.02, 0.03, 0.04};
    std::vector<Vec3> before;
    for (int i = 0; i < 6; ++i) before.push_back(place(s, copy("ball", i)));
    const Vec3 rests = place(s, "rests"), rolls = place(s, "rolls");
    run(s, 2);
    for (int i = 0; i < 6; ++i) {
      CAPTURE(i);
      const double a = 5.0 / 7 * rho[i] * g / r, t = a * 2 > speed ? speed / a : 2;
      const double moved = (place(s, copy("ball", i)) - before[size_t(i)]).norm();
      CHECK(moved == doctest::Approx(speed * t - 0.5 * a * t * t).epsilon(0.02));
    }
    CHECK((place(s, "rests") - rests).norm() < 2e-3);
    const double theta = std::atan(0.11);  // tan = 1.1 rho / r with rho = 0.02
    const double a = 5.0 / 7 * g * (std::sin(theta) - 0.1 * std::cos(theta));
    CHECK((place(s, "rolls") - rolls).norm() == doctest::Approx(2 * a).epsilon(0.1));
    const double tau[3] = {0.001, 0.004, 0.016};
    for (int i = 0; i < 3; ++i) {
      const double still = 12 - 2 * tau[i] * g / (0.4 * r * r);
      CHECK(body(s, copy("spinner", i)).omega.y() ==
            doctest::Approx(std::max(still, 0.0)).epsilon(0.01).scale(1));
    }
  }
}

TEST_CASE("dominoes: every one falls, in order") {
  BuiltScene s = shipped("dominoes", {"parameters.n=60"});
  run(s, 3);
  const auto upright = [&](int i) {
    return body(s, copy("domino", i)).pose.direction(Vec3::UnitY()).y();
  };
  CHECK(upright(0) < 0.8);
  CHECK(upright(59) > 0.999);
  run(s, 7);
  for (int i = 0; i < 60; ++i) CHECK_MESSAGE(upright(i) < 0.8, i);
}

TEST_CASE("cradle_exact: balls that touch hand the whole blow to the last one, and back") {
  BuiltScene s = shipped("cradle_exact");
  const auto speed = [&](int i) { return body(s, copy("ball", i)).v.norm(); };
  const auto energy = [&] { return s.world->frame()->stats.energies.total(); };
  const double e0 = energy();
  // A quarter of a period of 45 degrees is 0.756 s; then the last ball climbs as the first fell.
  run(s, 0.85);
  const double blow = std::sqrt(2 * 9.81 * 2.1 * (1 - std::sqrt(0.5)));
  CHECK(speed(4) == doctest::Approx(blow).epsilon(0.05));
  for (int i = 0; i < 4; ++i) CHECK(speed(i) < 0.01 * blow);
  run(s, 0.65);  // at the top
  CHECK(place(s, "ball[4]").y() == doctest::Approx(1.5151).epsilon(0.01));
  run(s, 0.9);  // and back
  CHECK(speed(0) == doctest::Approx(blow).epsilon(0.1));
  for (int i = 1; i < 5; ++i) CHECK(speed(i) < 0.02 * blow);
  CHECK(std::fabs(energy() - e0) < 0.01 * 7850 * 0.0654498 * 9.81 * 0.6151);
}

TEST_CASE("column_exact: nothing moves, and the plinth carries the weight to 1e-9") {
  BuiltScene s = shipped("column_exact");
  std::vector<Vec3> start;
  for (int i = 0; i < 12; ++i) start.push_back(place(s, copy("block", i)));
  run(s, 2);
  double weight = 0;
  for (int i = 0; i < 12; ++i) {
    CHECK((place(s, copy("block", i)) - start[size_t(i)]).norm() < 1e-9);
    weight += body(s, copy("block", i)).mass * 9.81;
  }
  Vec3 carried = Vec3::Zero();
  const BodyId plinth = s.bodies.at("plinth");
  for (const ContactFrame& c : s.world->frame()->all_contacts()) {
    if (c.a == plinth) carried += 60 * c.impulse;
    if (c.b == plinth) carried -= 60 * c.impulse;
  }
  CHECK((carried - Vec3(0, weight, 0)).norm() < 1e-9 * weight);
}

TEST_CASE("three_ball_break: simultaneous laws keep the symmetry, the sequential one does not") {
  // The closed form for one elastic ball on two: u = 2 sqrt(3) v / 5 at 30 degrees, v' = -v / 5.
  const double v = 1.5, u = 2 * std::sqrt(3.0) / 5 * v;
  for (const std::string law :
       {"reflections", "simultaneous_newton", "simultaneous_poisson", "sequential"}) {
    CAPTURE(law);
    BuiltScene s = shipped("three_ball_break", {"settings.event.impulses=" + law});
    run(s, 0.8);
    const Vec3 cue = body(s, "cue").v, left = body(s, "left").v, right = body(s, "right").v;
    const double asymmetry = (left - Vec3(right.x(), right.y(), -right.z())).norm();
    if (law == "sequential") {
      CHECK(asymmetry > 0.1);
    } else {
      CHECK(asymmetry < 1e-9);
      CHECK((cue - Vec3(-v / 5, 0, 0)).norm() < 1e-8);
      CHECK((right - u * Vec3(std::sqrt(0.75), 0, 0.5)).norm() < 1e-8);
    }
    CHECK((cue + left + right - Vec3(v, 0, 0)).norm() < 1e-9);
    CHECK(cue.squaredNorm() + left.squaredNorm() + right.squaredNorm() ==
          doctest::Approx(v * v).epsilon(1e-9));
  }
}

TEST_CASE("cradle: the blow comes back, and the middle ball has hardly moved") {
  BuiltScene s = shipped("cradle");
  const double height = place(s, "ball[0]").y() - 0.9;
  run(s, 1.5);  // half a period of the pendulum: the last ball is as high as the first was
  CHECK(place(s, "ball[4]").y() - 0.9 > 0.97 * height);
  CHECK(place(s, "ball[0]").y() - 0.9 < 0.01 * height);
  CHECK(std::fabs(place(s, "ball[2]").x()) < 0.005);
  run(s, 1.5);
  CHECK(place(s, "ball[0]").y() - 0.9 > 0.95 * height);
}

TEST_CASE("bullet_walls: walls are pierced, nothing passes through the steel plate") {
  BuiltScene s = shipped("bullet_walls");
  constexpr double plate = 6.8;  // its middle; it is 2 cm thick, 3.2 m wide and reaches up to 2.5 m
  std::map<std::string, Vec3> before;
  for (int k = 0; k < 150; ++k) {
    for_each_moving(s, [&](const RigidBody& b, const std::string& n) { before[n] = b.pose.x; });
    run(s, 1.0 / 60);
    for_each_moving(s, [&](const RigidBody& b, const std::string& name) {
      const Vec3 &from = before[name], &to = b.pose.x;
      if (from.x() > plate || to.x() < plate) return;
      // Ricochets fly around it and over it.
      const Vec3 x = from + (plate - from.x()) / (to.x() - from.x()) * (to - from);
      const bool through = std::fabs(x.z()) < 1.5 && x.y() > 0.15 && x.y() < 2.4;
      CHECK_MESSAGE(!through, name);
    });
  }
  int pierced = 0;
  for (int i = 0; i < 5; ++i) pierced += body(s, copy("bullet", i)).v.norm() < 950;
  CHECK(pierced == 5);
}

TEST_CASE("torus_chain: no ring leaves the next") {
  BuiltScene s = shipped("torus_chain");
  for (int k = 0; k < 8; ++k) {
    run(s, 0.25);
    for (int i = 0; i < 11; ++i) {
      const Vec3 next =
          i < 10 ? place(s, copy("link", i + 1)) : body(s, "weight[0]").body_frame().x;
      // Two circles of radius 0.2 with wires of 0.045 hang in each other up to 0.31 m apart.
      CHECK_MESSAGE((place(s, copy("link", i)) - next).norm() < 0.32, i);
    }
  }
}

TEST_CASE("convex_pile: comes to rest inside its bin without overlap") {
  BuiltScene s = shipped("convex_pile");
  run(s, 10);
  // 3.1 to 6.2 mm in runs whose gravity differs by 1e-5.
  CHECK(s.world->frame()->stats.max_penetration < 0.008);
  int inside = 0, slow = 0, all = 0;
  for_each_moving(s, [&](const RigidBody& b, const std::string&) {
    ++all;
    slow += b.v.norm() < 0.01;
    inside += std::fabs(b.pose.x.x()) < 2.1 && std::fabs(b.pose.x.z()) < 2.1;
    CHECK(b.pose.x.y() > 0.1);
  });
  CHECK(inside > 0.9 * all);
  CHECK(slow > 0.95 * all);
}

TEST_CASE("marble_run: the marbles end in the bowl") {
  BuiltScene s = shipped("marble_run", {"bodies.marble.repeat.count=3"});
  run(s, 22);
  for (int i = 0; i < 3; ++i) {
    const Vec3 x = place(s, copy("marble", i));
    CHECK_MESSAGE(std::hypot(x.x() - 1, x.z() - 0.6) < 0.42, i);
    CHECK_MESSAGE(x.y() < 0.45, i);
  }
}

TEST_CASE("demolition: stands until it is struck, and comes down") {
  BuiltScene s = shipped("demolition");
  const Vec3 before = place(s, "plate[12]");
  run(s, 0.5);
  CHECK((place(s, "plate[12]") - before).norm() < 0.01);
  run(s, 4.5);
  int down = 0;
  for (int i = 0; i < 24; ++i) down += place(s, copy("plate", i)).y() < 3;
  CHECK(down > 8);
  CHECK(s.world->frame()->stats.awake > 2900);
  for (int i = 0; i < 74 * 3 * 13; ++i)  // none hangs where the deck was
    if (const Vec3 x = place(s, copy("gravel", i)); std::abs(x.x()) < 5)
      CHECK_MESSAGE(x.y() < 4.2, i);
  for_each_moving(s, [&](const RigidBody& b, const std::string& name) {
    CHECK_MESSAGE(b.pose.x.y() > 0, name);
  });
}

TEST_CASE("what waits for a blow sleeps until it falls") {
  for (const char* name : {"brick_wall", "bullet_walls", "demolition", "dominoes"}) {
    CAPTURE(name);
    BuiltScene s = shipped(name);
    run(s, 1.0 / 60);
    CHECK(s.world->frame()->stats.awake <= 5);
  }
}

TEST_CASE("parts_feeder: 3,000 parts change belts, the fences align them, and none is lost") {
  // Reference: of random directions 22 % lie within 20 degrees of the line, and 44 % within 40.
  // What an L or a T leans on beside its long side turns it by up to 38 degrees.
  BuiltScene s = shipped("parts_feeder");
  std::map<std::string, double> start, before;
  for_each_moving(s, [&](const RigidBody& b, const std::string& name) {
    start[name] = before[name] = b.pose.x.x();
  });
  REQUIRE(start.size() >= 3300);
  std::array<int, 12> delivered{};  // by lane: have passed both fences
  int straight = 0, straight_aligned = 0, angled = 0, angled_aligned = 0;
  double fastest = 0, deepest = 0;
  for (int tick = 1; tick <= 12 * 60; ++tick) {
    run(s, 1.0 / 60);
    CHECK(s.world->frame()->stats.awake >= 2950);
    if (tick > 30) deepest = std::max(deepest, s.world->frame()->stats.max_penetration);
    fastest = std::max(fastest, greatest_speed(s));
    for_each_moving(s, [&](const RigidBody& b, const std::string& name) {
      double& x = before[name];
      if (start[name] < -1.6 && x < 4.1 && b.pose.x.x() >= 4.1) {  // has passed both fences
        const long lane = std::lround(b.pose.x.z() / 0.8 + 5.5);
        REQUIRE((lane >= 0 && lane < 12));
        ++delivered[size_t(lane)];
        const double along = std::fabs(b.pose.direction(Vec3::UnitX()).x());
        if (name[0] == 'b' || name[0] == 'r')
          ++straight, straight_aligned += along > std::cos(20 * M_PI / 180);
        else
          ++angled, angled_aligned += along > std::cos(40 * M_PI / 180);
      }
      x = b.pose.x.x();
    });
  }
  for (size_t lane = 0; lane < delivered.size(); ++lane)
    CHECK_MESSAGE(delivered[lane] > 5, "lane ", lane);
  CHECK(straight > 100);
  CHECK(straight_aligned > 0.55 * straight);
  CHECK(angled > 50);
  CHECK(angled_aligned > 0.55 * angled);
  CHECK(fastest < 5);
  CHECK(deepest < 0.035);
  int dropped = 0, in_trays = 0;
  for_each_moving(s, [&](const RigidBody& b, const std::string& name) {
    const Vec3 x = b.pose.x;
    dropped += start[name] < -4 && x.x() > -2.5 && x.y() < 1.2;  // by two belts
    const bool in_tray = x.x() > 4.4 && x.x() < 6.8 && x.y() > 0;
    in_trays += in_tray;
    const bool on_belts = x.x() > -8.9 && x.x() < 4.5 && x.y() > 0.9;
    CHECK_MESSAGE(((in_tray || on_belts) && std::fabs(x.z()) < 4.8), name, " at ", x.transpose());
  });
  CHECK(dropped > 70);
  CHECK(in_trays > 300);
}

TEST_CASE("planets: circles stay circles, the comet comes back, and the books balance") {
  BuiltScene s = shipped("planets");
  const Vec3 far = place(s, "comet");
  const double period = 2 * M_PI * std::sqrt(6.5 * 6.5 * 6.5 / 30);
  run(s, std::round(period * 240) / 240);
  CHECK((place(s, "comet") - far).norm() < 0.05);
  const double radii[] = {1.9, 2.9, 4.0, 5.2, 8.2, 10.6};
  const char* names[] = {"mercury", "venus", "earth", "mars", "jupiter", "saturn"};
  for (int i = 0; i < 6; ++i)
    CHECK(place(s, names[i]).norm() == doctest::Approx(radii[i]).epsilon(1e-3));
  CHECK(s.world->frame()->ledger->drift() < 1e-6);
}

TEST_CASE("fields: the vortex holds its motes around it, and the balls blow away with the wind") {
  BuiltScene s = shipped("fields");
  double start = 0;
  for (int i = 0; i < 90; ++i) start += place(s, copy("ball", i)).x() / 90;
  run(s, 5);
  double mean = 0;
  for (int i = 0; i < 90; ++i) mean += place(s, copy("ball", i)).x() / 90;
  CHECK(mean > start + 2);
  for (const char* name : {"warm", "cold"}) {
    const ParticleSystem* motes = s.world->particles(s.particles.find(name)->second);
    double turn = 0;
    for (size_t i = 0; i < motes->size(); ++i) {
      const Vec3 d = motes->x[i] - Vec3(-2.6, 1.9, 0);
      CHECK(d.norm() < 3);
      turn += d.cross(motes->v[i]).y() / double(motes->size());
    }
    CHECK(turn > 0.5);  // with the circulation, by the right hand
  }
}

TEST_CASE("microscope_*: apart, overlapping, and in time, with enough steps to learn from") {
  const auto watched = [](const BuiltScene& s) {
    std::vector<Pose> poses;
    const auto frame = s.world->frame();
    for (size_t i = 0; i < frame->body_slots(); ++i) poses.push_back(frame->body(i).pose);
    const MicroscopeSetup& setup = *s.microscope;
    return find_microscope(setup.algorithm)->record(make_slide(*frame, poses, setup));
  };
  const MicroscopeRecording apart = watched(shipped("microscope_gjk"));
  CHECK(apart.answer > 0.05);
  CHECK(apart.steps.size() >= 8);
  const MicroscopeRecording features =
      watched(shipped("microscope_gjk", {"microscope.algorithm=v_clip"}));
  CHECK(features.answer == doctest::Approx(apart.answer).epsilon(1e-9));
  const MicroscopeRecording deep = watched(shipped("microscope_gjk", {"parameters.gap=-0.4"}));
  CHECK(deep.answer < -0.05);
  CHECK(deep.steps.size() >= 8);
  const MicroscopeRecording walk = watched(shipped("microscope_v_clip"));
  CHECK(walk.answer > 0.05);
  CHECK(walk.steps.size() >= 6);
  const MicroscopeRecording time = watched(shipped("microscope_time"));
  CHECK(time.answer > 0.4);
  CHECK(time.answer < 0.7);
  CHECK(time.steps.size() >= 6);
}
