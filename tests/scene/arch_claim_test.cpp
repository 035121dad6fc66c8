// The scene `arch` under the exact stepper. References: statics (what stands above a joint weighs
// on it, and with vertical loads the thrust is the same in every joint), and limit analysis of
// masonry (Heyman, "The stone skeleton", 1966): the least and the greatest thrust for which a line
// of thrust lies within every joint, found here from the weights and the joints alone.
#include "engine/world/world.hpp"
#include "tests/scene/shipped_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

using namespace tumble;

namespace {

constexpr double gravity = 9.81;
constexpr int stones = 13, half_stones = 6;           // on each side of the keystone
constexpr double intrados = 1.515, extrados = 1.985;  // of the joints' faces [m]
const std::vector<std::string> exact{"settings.stepper=event"};

std::string stone_name(int i) {
  return i == half_stones ? "keystone" : copy("stone", i);
}

/// Joint k of the right half, counted from the keystone down to the springer (k = 0 ... 6).
double joint_angle(int k) {
  return M_PI / 2 - (k + 0.5) * M_PI / stones;
}

/// Whether a thrust H [N] has a line within all joints of the half arch. Moments about the arch's
/// centre give where it crosses joint k, an increasing function of where it crosses the first.
bool line_fits(const BuiltScene& s, double H) {
  const double V0 = 0.5 * gravity * body(s, "keystone").mass;
  const auto lever = [](int k, double h, double v) {
    return v * std::cos(joint_angle(k)) + h * std::sin(joint_angle(k));
  };
  double lowest = intrados, highest = extrados, weight = V0, moment = 0;
  const double at_top = lever(0, H, V0);
  for (int k = 1; k <= half_stones; ++k) {
    // Stone 5 is the keystone's neighbour on the right, stone 0 stands on the springer.
    const RigidBody& b = body(s, stone_name(half_stones - k));
    weight += gravity * b.mass;
    moment += gravity * b.mass * b.pose.x.x();
    const double lever_k = lever(k, H, weight);
    lowest = std::max(lowest, (intrados * lever_k - moment) / at_top);
    highest = std::min(highest, (extrados * lever_k - moment) / at_top);
  }
  return lowest <= highest;
}

std::map<std::string, Vec3> places(const BuiltScene& s) {
  std::map<std::string, Vec3> out;
  for_each_moving(s, [&](const RigidBody& b, const std::string& name) {
    if (name.rfind("ball", 0) != 0) out[name] = b.pose.x;
  });
  return out;
}

double farthest(const std::map<std::string, Vec3>& from, const std::map<std::string, Vec3>& to) {
  double most = 0;
  for (const auto& [name, x] : from) most = std::max(most, (to.at(name) - x).norm());
  return most;
}

/// What the contacts push one body with, that hold another [N].
Vec3 force_between(const BuiltScene& s, const ContactCertificates& found, const std::string& on,
                   const std::string& by) {
  const uint32_t a = s.bodies.at(by).index, b = s.bodies.at(on).index;
  Vec3 sum = Vec3::Zero();
  for (const ContactCertificate& c : found.contacts) {
    if (c.key.body_a == a && c.key.body_b == b) sum += c.force;
    if (c.key.body_a == b && c.key.body_b == a) sum -= c.force;
  }
  return sum;
}

}  // namespace

TEST_CASE("arch under the exact stepper: its stones touch from the start and stay where they are") {
  // The first ball lands after 0.504 s.
  BuiltScene s = shipped("arch", exact);
  const auto before = places(s);
  run(s, 0.5);
  CHECK(farthest(before, places(s)) < 1e-9);
  double weight = 0;
  for (const auto& stone : before) weight += gravity * body(s, stone.first).mass;
  Vec3 carried = Vec3::Zero();
  const BodyId ground = s.bodies.at("ground");
  for (const ContactFrame& c : s.world->frame()->all_contacts()) {
    if (c.a == ground) carried += 60 * c.impulse;
    if (c.b == ground) carried -= 60 * c.impulse;
  }
  CHECK((carried - Vec3(0, weight, 0)).norm() < 1e-9 * weight);
}

TEST_CASE("arch under the exact stepper: thrust and weight in every joint are those of statics") {
  BuiltScene s = shipped("arch", exact);
  run(s, 0.1);
  const auto found = s.world->contact_certificates();
  REQUIRE(found.ok());
  double weight = 0;  // of what is above a joint, on the right
  const double thrust = force_between(s, *found, stone_name(half_stones - 1), "keystone").x();
  const double whole = gravity * (2 * 6 + 1) * body(s, "keystone").mass;
  weight = 0.5 * gravity * body(s, "keystone").mass;
  for (int k = 0; k <= half_stones; ++k) {
    const int right = half_stones - 1 - k, left = half_stones + 1 + k;
    CAPTURE(k);
    for (const int i : {right, left}) {
      const bool foot = k == half_stones;
      const std::string on = foot ? copy("springer", i == right ? 1 : 0) : stone_name(i);
      const std::string by = stone_name(i == right ? i + 1 : i - 1);
      const Vec3 want((i == right ? 1 : -1) * thrust, -weight, 0);
      // Any shear at the crown is in equilibrium too. The solution of least norm has none, but for
      // what the solver leaves: of ten arches whose radius differs by 1e-7, two have up to 3e-5.
      CHECK((force_between(s, *found, on, by) - want).norm() < 1e-4 * whole);
    }
    if (right >= 0) weight += gravity * body(s, stone_name(right)).mass;
  }
  double least = 0, greatest = 0;
  const double step = 1e-3 * whole;
  for (double H = step; H < 5 * whole; H += step) {
    if (!line_fits(s, H)) continue;
    if (least == 0) least = H;
    greatest = H;
  }
  CAPTURE(thrust);
  CAPTURE(least);
  CAPTURE(greatest);
  CHECK(least > 0);
  CHECK(thrust > least - step);
  CHECK(thrust < greatest + step);
  for (const BodyBalance& b : found->bodies) CHECK(b.residual < 1e-8);
}

TEST_CASE("arch under the exact stepper: struck, its stones rattle, and each tick still ends") {
  // A hit at one joint opens others by nanometres, thousands of times in a tick. What is beyond the
  // budget is time-stepped. References: nothing gives energy, nothing comes in deeper than a
  // millimetre, and the lines of the ledger account for energy and momenta: what is left is the
  // error of the integrators, which in time-stepped ticks turn bodies with first order.
  BuiltScene s = shipped("arch", {"settings.stepper=event", "bodies.ball.position=[0.45,3.37,0.05]",
                                  "bodies.ball.velocity=[0,-4.9,0]"});
  const double turned =
      body(s, copy("ball", 0)).mass * 4.9 * 0.45;  // by the blow, about z [kg m^2/s]
  double energy = s.world->frame()->stats.energies.total();
  uint64_t time_stepped = 0;
  for (int tick = 0; tick < 30; ++tick) {
    REQUIRE(s.world->step().ok());  // the blow is in the first
    const auto frame = s.world->frame();
    CHECK(frame->stats.energies.total() < energy + 1e-6);
    CHECK(s.world->overlaps(1e-3).empty());
    energy = frame->stats.energies.total();
    time_stepped += frame->stats.time_stepped;
  }
  CHECK(time_stepped > 0);
  const Ledger& books = *s.world->frame()->ledger;
  const LedgerEntry left = books.line(LedgerLine::integrator).total();
  CHECK(books.line(LedgerLine::restitution).total().balance < -30);
  CHECK(books.line(LedgerLine::friction).total().balance < -30);
  CAPTURE(turned);
  CHECK(books.drift() < 1e-4);
  CHECK(left.momentum.norm() < 1e-6);
  CHECK(left.angular_momentum.norm() < 1e-3 * turned);
}
