// Contacts of bodies of several shapes: found by trees, known from tick to tick, shared among
// shapes. References: all pairs of shapes, asked one by one; what the corners of legs span, by the
// support function in many directions; statics of what stands on legs.
#include "engine/core/random.hpp"
#include "engine/dynamics/contact/cached_pair.hpp"
#include "engine/dynamics/contact/compound_pair.hpp"
#include "engine/dynamics/contact/pair_contacts.hpp"
#include "engine/dynamics/contact/shape_pairs.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/rigid_world.hpp"
#include "tests/support/scale.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double pi = std::numbers::pi;

Vec3 vector_in(Random& r, double size) {
  const double x = r.uniform(-size, size), y = r.uniform(-size, size);
  return {x, y, r.uniform(-size, size)};
}

Quat rotation_in(Random& r) {
  return axis_angle((vector_in(r, 1) + Vec3(0, 0, 1e-9)).normalized(), r.uniform(0, 3));
}

/// Boxes and balls, some apart and some in each other.
RigidBody random_compound(Random& r, int shapes) {
  BodyDef out;
  for (int i = 0; i < shapes; ++i) {
    ShapeDef s = r.uniform(0, 1) < 0.3
                     ? sphere(r.uniform(0.05, 0.2))
                     : box(r.uniform(0.02, 0.3), r.uniform(0.02, 0.3), r.uniform(0.02, 0.3));
    BodyDef one = body(std::move(s), Vec3::Zero());
    one.shapes[0].pose = {vector_in(r, 1), rotation_in(r)};
    out.shapes.push_back(one.shapes[0]);
  }
  return *make_body(out);
}

/// Feet around the y axis at `angles`, their soles at y = 0, 2 m from it.
BodyDef stool(const std::vector<double>& angles, double foot = 0.05) {
  BodyDef out = body(box(0.3, 0.1, 0.3), Vec3::Zero());
  out.shapes[0].pose.x.y() = 1.5;
  for (const double angle : angles) {
    BodyDef leg = body(box(foot, 0.5, foot), Vec3::Zero());
    leg.shapes[0].pose = {{2 * std::cos(angle), 0.5, 2 * std::sin(angle)},
                          axis_angle(Vec3::UnitY(), -angle)};
    out.shapes.push_back(leg.shapes[0]);
  }
  return out;
}

std::vector<double> even_angles(int n, double first = 0) {
  std::vector<double> out;
  for (int i = 0; i < n; ++i) out.push_back(first + 2 * pi * i / n);
  return out;
}

/// How far the corners of the soles reach beyond the contact's points in the worst of many
/// directions.
double unsupported(const RigidWorld& w, uint32_t slot) {
  const RigidBody& b = w.bodies[slot];
  double worst = 0;
  for (int k = 0; k < 720; ++k) {
    const Vec3 d(std::cos(pi * k / 360), 0, std::sin(pi * k / 360));
    double soles = -1e9, points = -1e9;
    for (size_t s = 1; s < b.shapes.size(); ++s) {
      const Vec3 half = b.shapes[s].shape->def().half_extents;
      for (const double x : {-half.x(), half.x()})
        for (const double z : {-half.z(), half.z()})
          soles = std::max(soles, d.dot(b.pose.point(b.shapes[s].pose.point({x, -half.y(), z}))));
    }
    for (const Contact& c : w.contacts.contacts())
      for (int i = 0; i < c.count; ++i)
        points = std::max(points, d.dot(contact_position(c, i, w.bodies)));
    worst = std::max(worst, soles - points);
  }
  return worst;
}

/// The least gap up to `margin` of all pairs of shapes, asked one by one; infinite without any.
double least_gap_of_all(std::span<const RigidBody> bodies, double margin, int& asked) {
  double least = std::numeric_limits<double>::infinity();
  for (const BodyShape& s : bodies[0].shapes) {
    for (const BodyShape& t : bodies[1].shapes) {
      std::vector<Manifold> found;
      collide(*s.shape, bodies[0].pose * s.pose, *t.shape, bodies[1].pose * t.pose, {margin},
              found);
      ++asked;
      for (const Manifold& m : found)
        for (const ManifoldPoint& p : m.used()) least = std::min(least, p.gap);
    }
  }
  return least;
}

/// What is known of two bodies, tick after tick, as ContactSet keeps it.
class KnownPair {
 public:
  explicit KnownPair(std::span<const RigidBody> bodies) : bodies_(bodies) {}

  void update() {
    const std::array<PairSide, 2> sides{pair_side(bodies_, {0, 0}, tick_),
                                        pair_side(bodies_, {1, 0}, tick_)};
    const PairContacts finder{sides, bodies_, tick_, &counted};
    const PairHistory history{contacts, known_.seen.empty() ? nullptr : known_.seen.data(),
                              known_.pieces};
    Sights sights;
    if (CompoundPair(finder, sides[0], sides[1], history).look(sights)) {
      for (Contact& c : contacts) carry_along(c, sides[0], sides[1]);
    } else {
      const std::vector<Contact> before = contacts;
      contacts.resize(sights.manifolds.size());
      finder.make({0, 1}, before, sights.manifolds, sights.shapes, contacts);
    }
    known_ = sights;
  }
  double least_gap() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Contact& c : contacts)
      for (const ContactPoint& p : c.used()) least = std::min(least, p.gap);
    return least;
  }
  double margin() const {
    return std::min(contact_margin(bodies_[0], tick_.margin),
                    contact_margin(bodies_[1], tick_.margin));
  }

  std::vector<Contact> contacts;
  static inline int asked = 0;  ///< how often the narrow phase was

 private:
  static void counted(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                      const ContactQuery& query, std::vector<Manifold>& out) {
    ++asked;
    collide(a, pose_a, b, pose_b, query, out);
  }
  std::span<const RigidBody> bodies_;
  SideTick tick_{Vec3::Zero(), 1.0 / 60, 0.02};
  Sights known_;
};

}  // namespace

TEST_CASE("a dynamic body has one proxy, a wall of another each: pairs are those that overlap") {
  Random r(65);
  for (int draw = 0; draw < scaled_count(60, 4); ++draw) {
    RigidWorld w;
    for (int i = 0; i < 30; ++i) {
      RigidBody b = random_compound(r, 1 + int(r.uniform(0, 6)));
      const double kind = r.uniform(0, 1);
      if (kind < 0.4) {
        b.type = kind < 0.2 ? BodyType::fixed : BodyType::kinematic;
        b.tree = nullptr;
      }
      b.pose = {vector_in(r, 3), rotation_in(r)};
      if (b.type != BodyType::fixed) b.v = vector_in(r, 1);
      w.bodies.push_back(b);
    }
    REQUIRE(w.tick().find_pairs(w.h).ok());
    std::vector<ProxyPair> expected;
    for (uint32_t i = 0; i < w.proxies.proxies.size(); ++i) {
      const uint32_t a = w.proxies.refs[i].body;
      const size_t shapes = w.bodies[a].shapes.size();
      CHECK(w.proxies.proxies_of(a) == (w.bodies[a].dynamic() ? 1 : shapes));
      for (uint32_t j = i + 1; j < w.proxies.proxies.size(); ++j) {
        const BroadPhaseProxy &p = w.proxies.proxies[i], &q = w.proxies.proxies[j];
        if (w.proxies.refs[j].body != a && (p.moving || q.moving) && p.bounds.overlaps(q.bounds))
          expected.push_back({i, j});
      }
    }
    CHECK(expected.size() > 30);
    CHECK(w.pairs == expected);
  }
}

TEST_CASE("what a hollow body holds is near it only where it is near a wall") {
  RigidWorld w;
  BodyDef room;
  room.type = BodyType::kinematic;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      Vec3 half = Vec3::Constant(5);
      half[axis] = 0.5;
      BodyDef wall = body(box(half.x(), half.y(), half.z()), Vec3::Zero());
      wall.shapes[0].pose.x[axis] = 5.5 * side;
      room.shapes.push_back(wall.shapes[0]);
    }
  const uint32_t holder = w.add(room);
  w.bodies[holder].omega = {0, 0, 0.5};
  w.add(body(box(0.5, 0.5, 0.5), Vec3::Zero()));
  const uint32_t cornered = w.add(body(box(0.5, 0.5, 0.5), {4.5, 4.5, 4.5}));
  REQUIRE(w.tick().find_pairs(w.h).ok());
  REQUIRE(w.pairs.size() == 3);
  for (const ProxyPair& pair : w.pairs) {
    CHECK(w.proxies.refs[pair.a].body == holder);
    CHECK(w.proxies.refs[pair.b].body == cornered);
  }
}

TEST_CASE("what is known of two bodies has the gaps of all pairs of shapes, asked seldom") {
  Random r(63);
  int asked_one_by_one = 0, touching = 0, apart = 0;
  KnownPair::asked = 0;
  for (int draw = 0; draw < scaled_count(60, 4); ++draw) {
    std::array<RigidBody, 2> bodies{random_compound(r, 2 + int(r.uniform(0, 12))),
                                    random_compound(r, 1 + int(r.uniform(0, 12)))};
    bodies[0].pose = {vector_in(r, 10), rotation_in(r)};
    bodies[1].pose = {bodies[0].pose.x + vector_in(r, 1.2), rotation_in(r)};
    KnownPair known(bodies);
    const double step = std::pow(10.0, r.uniform(-5, -2.5));
    const Vec3 way = vector_in(r, step), turn = vector_in(r, step);
    for (int i = 0; i < 100; ++i) {
      bodies[1].pose.x += way + vector_in(r, 0.3 * step);
      bodies[1].pose.q =
          (axis_angle((turn + vector_in(r, 0.1 * step)).normalized(), step) * bodies[1].pose.q)
              .normalized();
      const Pose common{vector_in(r, 1), rotation_in(r)};
      for (RigidBody& b : bodies) b.pose = common * b.pose;
      known.update();
      const double least = least_gap_of_all(bodies, known.margin(), asked_one_by_one);
      // What was carried along may have moved by a fiftieth of the margin.
      const double error = 0.02 * known.margin() + 1e-12;
      if (least < known.margin() - error) {
        ++touching;
        // Deep in each other another axis may be that of least overlap by now.
        if (least > -0.005) CHECK(std::fabs(known.least_gap() - least) <= error);
        CHECK_FALSE(known.contacts.empty());
      } else {
        ++apart;
        CHECK(known.least_gap() >= known.margin() - error);
      }
    }
  }
  CHECK(touching > apart / 10);
  CHECK(apart > touching / 10);
  CHECK(KnownPair::asked < asked_one_by_one / 20);
}

TEST_CASE("what is known of bodies of several shapes survives saving, to the bit") {
  RigidWorld one, two;
  Random r(64);
  for (RigidWorld* w : {&one, &two}) w->floor();
  for (int i = 0; i < 6; ++i) {
    BodyDef def = stool(even_angles(4 + i), 0.2);
    def.pose = {{0.5 * i, 0.5 + 2.2 * i, 0.3 * i}, rotation_in(r)};
    for (RigidWorld* w : {&one, &two}) w->add(def);
  }
  one.run(3);
  CHECK(one.contacts.contacts().size() >= 6);
  ByteWriter out;
  one.contacts.save(out);
  ByteReader in(out.bytes());
  REQUIRE(two.contacts.load(in, uint32_t(two.bodies.size())));
  two.bodies = one.bodies;
  CHECK(two.hash() == one.hash());
  for (int i = 0; i < 60; ++i) {
    one.step();
    two.step();
    CHECK(one.hash() == two.hash());
  }
}

TEST_CASE("pairs of shapes found by the trees hold all that are near, and few that are far") {
  Random r(61);
  size_t listed = 0, near = 0, all = 0;
  for (int draw = 0; draw < scaled_count(400, 16); ++draw) {
    RigidBody a = random_compound(r, 1 + int(r.uniform(0, 20)));
    RigidBody b = random_compound(r, 1 + int(r.uniform(0, 20)));
    a.pose = {vector_in(r, 100), rotation_in(r)};
    b.pose = {a.pose.x + vector_in(r, 0.9), rotation_in(r)};
    const double reach = r.uniform(0, 0.1);
    std::vector<ShapesNear> pairs;
    const double others = find_shape_pairs(side_shapes(a, 0), side_shapes(b, 0), reach, pairs);
    CHECK(others >= reach);
    CHECK(std::ranges::is_sorted(pairs, {}, &ShapesNear::shapes));
    CHECK(std::ranges::adjacent_find(pairs, {}, &ShapesNear::shapes) == pairs.end());
    listed += pairs.size();
    all += a.shapes.size() * b.shapes.size();
    for (uint32_t i = 0; i < a.shapes.size(); ++i) {
      for (uint32_t j = 0; j < b.shapes.size(); ++j) {
        std::vector<Manifold> found;
        collide(*a.shapes[i].shape, a.pose * a.shapes[i].pose, *b.shapes[j].shape,
                b.pose * b.shapes[j].pose, {others}, found);
        if (found.empty()) continue;
        ++near;
        const ShapesOfPair at{i, j};
        const auto listed = std::ranges::lower_bound(pairs, at, {}, &ShapesNear::shapes);
        REQUIRE(listed != pairs.end());
        REQUIRE(listed->shapes == at);
        CHECK(listed->apart <= std::max(0.0, found[0].points[0].gap) + 1e-12);
      }
    }
  }
  CHECK(near > 0.02 * double(all));
  CHECK(listed < 4 * near);
}

TEST_CASE("a body stands on all of its legs, however many shapes share its contact") {
  Random r(62);
  for (const int legs : {3, 4, 5, 6, 8, 12, 17}) {
    for (int draw = 0; draw < 6; ++draw) {
      std::vector<double> angles = even_angles(legs, r.uniform(0, 1));
      if (draw > 2)
        for (double& angle : angles) angle = r.uniform(0, 2 * pi);
      RigidWorld w;
      w.floor();
      BodyDef def = stool(angles);
      def.pose = {{r.uniform(-3, 3), 0.001, r.uniform(-3, 3)},
                  axis_angle(Vec3::UnitY(), r.uniform(0, 6))};
      const uint32_t slot = w.add(def);
      w.find_contacts();
      REQUIRE_FALSE(w.contacts.contacts().empty());
      for (const Contact& c : w.contacts.contacts()) {
        CHECK(c.normal.y() == doctest::Approx(1));
        for (int i = 0; i < c.count; ++i) CHECK(c.points[size_t(i)].gap == doctest::Approx(0.001));
      }
      // What is left out lies inside by the tenth of the extent that is allowed.
      CHECK(unsupported(w, slot) <= 0.1 * 4.2 + 1e-9);
      CHECK(w.contacts.contacts().size() <= size_t((legs + 3) / 4 + 1));
    }
  }
}

TEST_CASE("a stool of six legs with its weight near the line of two of them does not tip") {
  for (int side = 0; side < 6; ++side) {
    RigidWorld w;
    w.floor();
    BodyDef def = stool(even_angles(6));
    const double towards = pi / 6 + side * pi / 3, apothem = 2 * std::cos(pi / 6);
    def.mass = 10;
    def.inertia = Vec3(8, 8, 8);
    def.centre = 0.9 * apothem * Vec3(std::cos(towards), 0, std::sin(towards)) + Vec3(0, 0.3, 0);
    const uint32_t slot = w.add(def);
    const Pose before = w.bodies[slot].pose;
    w.run(3);
    CHECK((w.bodies[slot].pose.x - before.x).norm() < 0.005);
    CHECK(w.bodies[slot].pose.q.angularDistance(before.q) < 0.005);
  }
}

TEST_CASE("a block that is cut into pieces touches as the whole does, by one entry of the cache") {
  RigidWorld cut, whole;
  BodyDef pieces, block = body(box(0.9, 0.3, 0.9), {0, 0.299, 0});
  for (int i = -1; i <= 1; ++i)
    for (int k = -1; k <= 1; ++k) {
      BodyDef piece = body(box(0.3, 0.3, 0.3), Vec3::Zero());
      piece.shapes[0].pose.x = {0.6 * i, 0, 0.6 * k};
      pieces.shapes.push_back(piece.shapes[0]);
    }
  pieces.pose = block.pose;
  pieces.can_sleep = block.can_sleep = false;
  for (RigidWorld* w : {&cut, &whole}) {
    w->floor();
    w->add(w == &cut ? pieces : block);
    w->find_contacts();
    REQUIRE(w->contacts.contacts().size() == 1);
  }
  const Contact &c = cut.contacts.contacts()[0], &d = whole.contacts.contacts()[0];
  REQUIRE(c.count == 4);
  for (int i = 0; i < 4; ++i) {
    double nearest = 1;
    for (int k = 0; k < 4; ++k)
      nearest =
          std::min(nearest, (c.points[size_t(i)].anchor_b - d.points[size_t(k)].anchor_b).norm());
    CHECK(nearest < 1e-12);
    CHECK(c.points[size_t(i)].gap == doctest::Approx(-0.001));
  }
  cut.run(1);
  RealtimeTick tick = cut.tick();
  REQUIRE(tick.find_pairs(cut.h).ok());
  CHECK(cut.pairs.size() == 1);
  tick.find_contacts(cut.h, cut.settings);
  CHECK(tick.report.contacts.carried == 1);
  CHECK(cut.contacts.contacts().size() == 1);
}

TEST_CASE("shapes of other materials keep contacts of their own") {
  RigidWorld w;
  w.floor(1);
  BodyDef def = stool(even_angles(4));
  def.shapes[2].material.friction = 0.25;
  w.add(def);
  w.find_contacts();
  REQUIRE(w.contacts.contacts().size() == 2);
  for (const Contact& c : w.contacts.contacts())
    CHECK(c.friction == doctest::Approx(c.shapes.b == 2 ? 0.5 : std::sqrt(0.5)));
}

TEST_CASE("bodies of several shapes that meet within a tick have a contact at its start") {
  // Reference: the gaps of all pairs of shapes at several moments of the tick.
  Random r(65);
  int all = 0, met = 0, passed = 0, asked = 0;
  for (int draw = 0; draw < scaled_count(40, 3); ++draw) {
    std::array<RigidBody, 2> bodies{random_compound(r, 2 + int(r.uniform(0, 12))),
                                    random_compound(r, 1 + int(r.uniform(0, 12)))};
    bodies[0].pose = {vector_in(r, 10), rotation_in(r)};
    const Vec3 side = vector_in(r, 1);
    for (RigidBody& b : bodies) {
      b.v = vector_in(r, 8);
      b.omega = vector_in(r, 6);
      b.looks_far = true;  // foresees all of its motion
    }
    // their centres pass each other after half of the ticks
    constexpr int ticks = 16, moments = 5;
    const double h = 1.0 / 60;
    bodies[1].pose = {bodies[0].pose.x + side - 0.5 * ticks * h * (bodies[1].v - bodies[0].v),
                      rotation_in(r)};
    KnownPair known(bodies);
    for (int i = 0; i < ticks; ++i) {
      known.update();
      ++all;
      const std::array<Pose, 2> start{bodies[0].pose, bodies[1].pose};
      double least = 1;
      for (int k = 0; k < moments; ++k) {
        const double t = h * k / (moments - 1);
        for (size_t j = 0; j < 2; ++j) {
          const double angle = t * bodies[j].omega.norm();
          bodies[j].pose = {start[j].x + t * bodies[j].v,
                            axis_angle(bodies[j].omega.normalized(), angle) * start[j].q};
        }
        least = std::min(least, least_gap_of_all(bodies, known.margin(), asked));
      }
      if (least > 0.9 * known.margin()) {
        passed += known.contacts.empty();
        continue;
      }
      ++met;
      CHECK_FALSE(known.contacts.empty());
    }
  }
  CHECK(met > 0.05 * all);
  CHECK(passed > 0.05 * all);
}
