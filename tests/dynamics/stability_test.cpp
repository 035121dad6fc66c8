// Structures that stand in the world must stand here: displacement after 10 s at 60 Hz, sleeping
// off, so that nothing is frozen in place. Reference: the initial placement, which is an exact
// equilibrium of rigid bodies.
#include "tests/dynamics/piles.hpp"

using namespace tumble;
using namespace tumble::test;

TEST_CASE("a stack of ten boxes drifts by less than 1 mm") {
  for (const bool precise : {false, true}) {
    RigidWorld w;
    w.settings.sleeping = false;
    w.settings.precise = precise;
    w.floor();
    for (int i = 0; i < 10; ++i) w.add(body(box(0.5, 0.5, 0.5), {0, 0.5 + i, 0}));
    w.run(10);
    const RigidBody& top = w.bodies.back();
    CHECK(std::abs(top.pose.x.x()) < 1e-3);
    CHECK(std::abs(top.pose.x.z()) < 1e-3);
    CHECK(9.5 - top.pose.x.y() < (precise ? 5e-3 : 0.03));
    CHECK(top.v.norm() < (precise ? 1e-6 : 1e-3));
    // What the bottom carries is the weight of all.
    double impulse = 0;
    for (const Contact& c : w.contacts.contacts()) {
      if (c.key.body_a != 0) continue;
      for (int i = 0; i < c.count; ++i) impulse += contact_impulse(c, i).y();
    }
    CHECK(impulse == doctest::Approx(10 * 1000 * 9.81 / 60).epsilon(1e-4));
  }
}

TEST_CASE("1 kg carries 1000 kg (A8: the best peer at 60 Hz sinks by 86 mm, others collapse)") {
  for (const double mass : {100.0, 1000.0}) {
    RigidWorld w;
    w.settings.sleeping = false;
    w.floor();
    BodyDef small = body(box(0.5, 0.5, 0.5), {0, 0.5, 0});
    BodyDef large = body(box(0.5, 0.5, 0.5), {0, 1.5, 0});
    small.mass = 1;
    large.mass = mass;
    w.add(small);
    w.add(large);
    double lowest = 2;
    for (int k = 0; k < 600; ++k) {
      w.step();
      lowest = std::min(lowest, w.bodies[2].pose.x.y());
    }
    CHECK(1.5 - lowest < 0.05);
    CHECK(w.bodies[2].v.norm() < 1e-3);
    CHECK(std::abs(w.bodies[2].pose.x.x()) < 5e-3);
  }
}

TEST_CASE("card houses stand (A9: every peer but one falls at 60 Hz)" *
          doctest::test_suite("long")) {
  for (const int levels : {2, 3, 5}) {
    RigidWorld w;
    w.settings.sleeping = false;
    add_card_house(w, levels);
    const std::vector<RigidBody> start = w.bodies;
    w.run(scaled(10, 1));
    CHECK(displacement(w, start) < 0.01);
    CHECK(w.kinetic_energy() < 1e-6);
  }
}

TEST_CASE("an arch of wedges stands") {
  for (const bool precise : {false, true})
    for (const int stones : {9, 15}) {
      RigidWorld w;
      w.settings.sleeping = false;
      w.settings.precise = precise;
      add_arch(w, stones);
      const std::vector<RigidBody> start = w.bodies;
      w.run(scaled(10, 5));  // the ordinary solve takes some seconds to come to rest
      CHECK(displacement(w, start) < (precise ? 0.005 : 0.04));
      CHECK(w.kinetic_energy() < 1e-6);
    }
}

TEST_CASE("ticks from 1/30 to 1/1000 s stack boxes alike") {
  for (const double hz : {30.0, 120.0, 240.0, 1000.0}) {
    RigidWorld w(hz);
    w.floor();
    for (int i = 0; i < 5; ++i) w.add(body(box(0.5, 0.5, 0.5), {0, 0.5 + 1.01 * i, 0}));
    w.run(3);
    CHECK(w.bodies.back().pose.x.y() == doctest::Approx(4.5).epsilon(2e-3));
    CHECK(w.bodies.back().v.norm() < 0.01);
  }
}

TEST_CASE("small and large worlds behave alike: gears of a watch and blocks of a house") {
  for (const double size : {0.005, 0.05, 20.0}) {
    RigidWorld w;
    w.floor();
    for (int i = 0; i < 4; ++i) {
      w.add(body(box(size, size, size), {0.1 * size * (i % 2), size * (1 + 2.02 * i), 0}));
    }
    w.run(4);
    CHECK(w.bodies.back().pose.x.y() / size == doctest::Approx(7).epsilon(0.01));
    CHECK(w.awake() == 0);
  }
}
