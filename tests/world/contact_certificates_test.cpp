// Certificates of contacts of worlds. References: statics and Coulomb's law in closed form.
#include "tests/support/test_world.hpp"

#include <cmath>

using namespace tumble;
using test::TestWorld;

namespace {

WorldSettings settings_of(std::string_view stepper, const Vec3& gravity = {0, -9.81, 0}) {
  WorldSettings s;
  s.stepper = stepper;
  s.gravity = gravity;
  return s;
}

Vec3 sum_on_b(const ContactCertificates& c) {
  Vec3 sum = Vec3::Zero();
  for (const ContactCertificate& p : c.contacts)
    if (p.key.body_a == 0) sum += p.force;
  return sum;
}

}  // namespace

TEST_CASE("certificates of a world: a column presses with its weight, under both steppers") {
  for (const auto& [stepper, tolerance] : {std::pair{"event", 1e-9}, {"realtime", 1e-3}}) {
    const auto& shown_stepper = stepper;
    CAPTURE(shown_stepper);
    TestWorld w(settings_of(stepper));
    w.ground();
    double weight = 0;
    for (int i = 0; i < 4; ++i) {
      const BodyId b = w.box({0.02 * i, 0.5 + i, 0});
      weight += w.world->body(b)->mass * 9.81;
    }
    w.run(1);
    const uint64_t hash = w->state_hash();
    const auto c = w->contact_certificates();
    REQUIRE(c.ok());
    CHECK((sum_on_b(*c) - Vec3(0, weight, 0)).norm() < tolerance * weight);
    for (const ContactCertificate& p : c->contacts) CHECK(p.place_in_cone <= 1 + 1e-9);
    for (const BodyBalance& b : c->bodies) CHECK(b.residual < 1e-9);
    CHECK(c->bodies.size() == (std::string_view(stepper) == "event" ? 4u : 0u));
    CHECK(w->state_hash() == hash);
  }
}

TEST_CASE(
    "certificates of a world: they say whether a block holds or slides, and how far in the cone") {
  for (const auto& [stepper, slope] :
       {std::pair{"event", 0.3}, {"event", 0.8}, {"realtime", 0.3}, {"realtime", 0.8}}) {
    const auto& shown_stepper = stepper;
    CAPTURE(shown_stepper);
    const auto& shown_slope = slope;
    CAPTURE(shown_slope);
    const double theta = std::atan(slope);
    TestWorld w(settings_of(stepper, {9.81 * std::sin(theta), -9.81 * std::cos(theta), 0}));
    w.ground();
    const BodyId b = w.box({0, 0.5, 0});
    w.run(0.5);
    const auto c = w->contact_certificates();
    REQUIRE(c.ok());
    const bool slides = slope > 0.5;
    const double weight = w.world->body(b)->mass * 9.81;
    int pressing = 0;
    for (const ContactCertificate& p : c->contacts) {
      if (p.mode == ContactMode::open) continue;
      ++pressing;
      CHECK(p.mode == (slides ? ContactMode::sliding : ContactMode::sticking));
    }
    CHECK(pressing > 0);
    const double friction = slides ? 0.5 * std::cos(theta) : std::sin(theta);
    CHECK(sum_on_b(*c).x() == doctest::Approx(-friction * weight).epsilon(1e-3));
  }
}

TEST_CASE("settings of the event stepper: solvers and cones that there are not are refused") {
  TestWorld w(settings_of("event"));
  WorldSettings s = w->settings();
  s.event.contact_solver = "barraff";
  const Status solver = w->set_settings(s);
  REQUIRE_FALSE(solver.ok());
  CHECK(solver.error().text().find("baraff") != std::string::npos);
  s.event.contact_solver = "pgs";
  s.event.friction_cone = "square";
  CHECK_FALSE(w->set_settings(s).ok());
}
