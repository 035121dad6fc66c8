// Contacts that are carried along with bodies that hardly move. References: the narrow phase,
// asked again at the same poses, and bounds on how far a distance can change.
#include "engine/dynamics/contact/cached_pair.hpp"

#include "engine/dynamics/contact/pair_contacts.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/piles.hpp"
#include "tests/dynamics/rigid_world.hpp"

#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

Vec3 vector_in(Random& r, double size) {
  const double x = r.uniform(-size, size), y = r.uniform(-size, size);
  return {x, y, r.uniform(-size, size)};
}

/// A turn by up to `angle` about a random axis.
Quat rotation_in(Random& r, double angle) {
  const Vec3 axis = vector_in(r, 1) + Vec3(0, 0, 1e-9);
  return axis_angle(axis.normalized(), r.uniform(0, angle));
}

struct Found {
  std::vector<Contact> contacts;
  std::vector<CachedPair> seen;
  bool carried = false;

  double least_gap() const {
    double gap = 1;
    for (const Contact& c : contacts)
      for (int i = 0; i < c.count; ++i) gap = std::min(gap, c.points[size_t(i)].gap);
    return gap;
  }
};

const SideTick tick{Vec3::Zero(), 1.0 / 60, 0.02};

std::array<PairSide, 2> sides_of(std::span<const RigidBody> bodies) {
  const auto side = [&](uint32_t body) { return pair_side(bodies, {body, 0}, tick); };
  return {side(0), side(1)};
}

Found find(std::span<const RigidBody> bodies, const Found* before) {
  const std::array<PairSide, 2> sides = sides_of(bodies);
  const PairContacts finder{sides, bodies, tick};
  PairHistory history;
  if (before) history = {before->contacts, before->seen.data()};
  const ProxyPair pair{0, 1};
  Found out;
  out.carried = before && finder.knows(pair, history);
  if (!before || !out.carried) {
    Sights sights;
    finder.look(pair, history, sights);
    out.contacts.resize(sights.manifolds.size());
    finder.make(pair, history.contacts, sights.manifolds, sights.shapes, out.contacts);
    out.seen = sights.seen;
    return out;
  }
  out.contacts = before->contacts;
  out.seen = before->seen;
  for (Contact& c : out.contacts) carry_along(c, sides[0], sides[1]);
  return out;
}

/// Two boxes, the second flat on top of the first, or beside a face, an edge or a corner of it.
std::array<RigidBody, 2> near_boxes(Random& r, bool flat) {
  std::array<RigidBody, 2> out{*make_body(body(box(0.5, 0.4, 0.6), Vec3::Zero())),
                               *make_body(body(box(0.3, 0.5, 0.4), Vec3::Zero()))};
  const Quat common = rotation_in(r, 3);
  const Quat own = flat ? axis_angle(Vec3::UnitY(), r.uniform(0, 6)) : rotation_in(r, 3);
  const double up = flat ? 0.9 + r.uniform(-0.005, 0.01) : r.uniform(0.85, 1.1);
  const Vec3 at(r.uniform(-0.6, 0.6), up, r.uniform(-0.7, 0.7));
  out[0].pose = {vector_in(r, 5), common};
  out[1].pose = {out[0].pose.point(at), common * own};
  return out;
}

}  // namespace

TEST_CASE("carried contacts have the gaps of the narrow phase, to second order where planes meet") {
  Random r(5);
  int carried = 0, flat = 0, apart = 0;
  for (int draw = 0; draw < scaled(20000, 400); ++draw) {
    const bool on_top = draw % 2 == 0;
    auto bodies = near_boxes(r, on_top);
    const Found before = find(bodies, nullptr);
    CHECK_FALSE(before.carried);
    const Pose common{vector_in(r, 1), rotation_in(r, 2)};
    const double step = std::pow(10.0, r.uniform(-7, -3.3));
    bodies[1].pose = {bodies[1].pose.x + vector_in(r, step),
                      (rotation_in(r, step) * bodies[1].pose.q).normalized()};
    for (RigidBody& b : bodies) b.pose = common * b.pose;  // moving together is no motion
    const Found now = find(bodies, &before);
    const std::array<PairSide, 2> sides = sides_of(bodies);
    const double moved = moved_since(before.seen[0], sides[0], sides[1]);
    CHECK(moved >= 0);
    const double enough = std::pow(10.0, r.uniform(-7, -3));
    const double sooner = moved_since(before.seen[0], sides[0], sides[1], enough);
    CHECK((sooner <= enough) == (moved <= enough));
    if (sooner <= enough) CHECK(sooner == moved);
    // That nothing was there may be known for longer, by how far apart they were.
    if (!before.contacts.empty() || moved <= seen_tolerance(0.02))
      CHECK(now.carried == (moved <= seen_tolerance(0.02)));
    if (!now.carried) continue;
    ++carried;
    apart += moved > seen_tolerance(0.02);
    const Found again = find(bodies, nullptr);
    if (again.contacts.empty()) {
      if (!now.contacts.empty()) CHECK(now.least_gap() > 0.02 - moved);
      continue;
    }
    REQUIRE_FALSE(now.contacts.empty());
    // Deep in each other the axis of least overlap may change, and the points with it.
    if (before.least_gap() < -0.005) continue;
    CHECK(std::fabs(now.least_gap() - again.least_gap()) <= moved + 1e-12);
    const Contact &c = now.contacts[0], &d = again.contacts[0];
    if (!on_top || c.count < 3 || d.count != c.count) continue;
    CHECK(c.normal.dot(d.normal) > 1 - 10 * moved * moved);
    // Of more than four corners another four may be kept now.
    for (int i = 0; i < c.count; ++i)
      for (int k = 0; k < d.count; ++k) {
        const ContactPoint &p = c.points[size_t(i)], &q = d.points[size_t(k)];
        if (p.feature != q.feature) continue;
        CHECK(std::fabs(p.gap - q.gap) <= 10 * moved * moved + 1e-12);
        ++flat;
      }
  }
  CHECK(carried > scaled(20000, 400) / 3);
  CHECK(flat > scaled(20000, 400) / 20);
  CHECK(apart > 0);
}

TEST_CASE("a motion that comes back is no motion, a way travelled in small steps is") {
  Random r(6);
  auto bodies = near_boxes(r, true);
  bodies[1].pose.q = bodies[0].pose.q;
  bodies[1].pose.x = bodies[0].pose.point({0, 0.901, 0});
  const Found first = find(bodies, nullptr);
  Found last = first;
  int looks = 0;
  for (int i = 0; i < 100; ++i) {
    bodies[1].pose.x.x() += 1e-5;
    last = find(bodies, &last);
    looks += !last.carried;
  }
  CHECK(looks == 2);  // every 0.4 mm of the 1 mm
  bodies[1].pose.x.x() -= 100e-5;
  CHECK(find(bodies, &first).carried);
}

TEST_CASE("belts and directions turn with bodies that turn together") {
  auto bodies = std::array<RigidBody, 2>{*make_body(body(box(1, 1, 1), Vec3::Zero())),
                                         *make_body(body(box(1, 1, 1), {0, 2.001, 0}))};
  bodies[0].shapes[0].material.surface_velocity = {2, 0, 0};
  const Found before = find(bodies, nullptr);
  const Pose turn{{3, 1, 2}, axis_angle(Vec3::UnitZ(), 1.2)};
  for (RigidBody& b : bodies) b.pose = turn * b.pose;
  const Found now = find(bodies, &before), again = find(bodies, nullptr);
  REQUIRE(now.carried);
  CHECK((now.contacts[0].normal - again.contacts[0].normal).norm() < 1e-14);
  CHECK((now.contacts[0].surface_velocity - again.contacts[0].surface_velocity).norm() < 1e-14);
  CHECK((now.contacts[0].surface_velocity - turn.direction({2, 0, 0})).norm() < 1e-14);
}

TEST_CASE("round shapes that are apart are left alone only as long as they cannot touch") {
  Random r(8);
  int left_alone = 0;
  for (int draw = 0; draw < scaled(20000, 400); ++draw) {
    auto bodies = std::array<RigidBody, 2>{*make_body(body(box(0.5, 0.4, 0.6), Vec3::Zero())),
                                           *make_body(body(capsule(0.2, 0.7), Vec3::Zero()))};
    bodies[0].pose = {vector_in(r, 5), rotation_in(r, 3)};
    bodies[1].pose = {bodies[0].pose.x + vector_in(r, 1.2), rotation_in(r, 3)};
    const Found before = find(bodies, nullptr);
    bodies[1].pose = {bodies[1].pose.x + vector_in(r, 0.1),
                      (rotation_in(r, 0.1) * bodies[1].pose.q).normalized()};
    if (!find(bodies, &before).carried) continue;
    ++left_alone;
    CHECK(find(bodies, nullptr).contacts.empty());
  }
  CHECK(left_alone > scaled(20000, 400) / 20);
}

TEST_CASE("round shapes roll: nothing is carried") {
  auto bodies = std::array<RigidBody, 2>{*make_body(body(box(1, 1, 1), Vec3::Zero())),
                                         *make_body(body(sphere(0.5), {0, 1.501, 0}))};
  const Found before = find(bodies, nullptr);
  CHECK(before.seen.empty());
  CHECK_FALSE(find(bodies, &before).carried);
}
