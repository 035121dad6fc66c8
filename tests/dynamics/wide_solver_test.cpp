// The bundles. References: the scalar rows in double precision, row for row in the order
// of the colours; conservation of momentum; closed forms of sliding, bouncing and rolling; the same
// bytes for every instruction set and number of threads.
#include "engine/dynamics/realtime/integrate_bodies.hpp"
#include "engine/dynamics/realtime/wide/colouring.hpp"
#include "engine/dynamics/realtime/wide/wide_island.hpp"
#include "tests/dynamics/piles.hpp"

#include <algorithm>

#include <hwy/targets.h>

using namespace tumble;
using namespace tumble::test;

namespace {

/// A world all of whose contacts are solved in bundles.
class WideWorld : public RigidWorld {
 public:
  explicit WideWorld(int threads = 1) : RigidWorld(60, threads) { settings.sleeping = false; }

  void step() {
    find_contacts();
    solve();
  }
  void run(double seconds) {
    for (int i = int(seconds / h + 0.5); i > 0; --i) step();
  }
  /// The contacts as they are, then what touches nothing, and kinematic bodies.
  void solve() {
    build_islands(bodies, contacts, links, h, islands);
    const SolverContext context{bodies, contacts.contacts(), gravity, h, &settings, {}};
    std::vector<uint32_t> which;
    for (uint32_t k = 0; k < islands.islands.size(); ++k) {
      const Island& island = islands.islands[k];
      if (island.contact_begin < island.contact_end) which.push_back(k);
    }
    plans.make(context, islands, crew);  // of which only the traits count
    wide.lay_out(context, islands, which, plans.traits(), WideSort::contacts, crew);
    if (!wide.empty()) wide.solve(context, crew);
    for (const Island& island : islands.islands)
      for (uint32_t k = island.body_begin; k < island.body_end; ++k)
        if (island.contact_begin == island.contact_end) fly(bodies[islands.bodies[k]], gravity, h);
    for (RigidBody& b : bodies)
      if (b.type == BodyType::kinematic) carry(b, h);
  }

  SolvePlans plans;
  WideIsland wide;
};

/// Contacts of the set in the order of the colours.
std::vector<uint32_t> by_colour(const RigidWorld& w) {
  std::vector<ColourEdge> edges;
  for (const Contact& c : w.contacts.contacts()) {
    const auto end = [&](uint32_t slot) {
      return w.bodies[slot].dynamic() ? slot : ColourEdge::fixed;
    };
    edges.push_back({end(c.key.body_a), end(c.key.body_b)});
  }
  Colouring colouring;
  colouring.assign(edges, uint32_t(w.bodies.size()));
  REQUIRE(colouring.left_over().empty());
  std::vector<uint32_t> order;
  for (uint32_t k = 0; k < colouring.colours(); ++k)
    order.insert(order.end(), colouring.of(k).begin(), colouring.of(k).end());
  return order;
}

/// One tick of all bodies by the scalar rows in double precision.
struct ScalarTick {
  std::vector<SolverBody> bodies;
  std::vector<SolverMotion> motions;
  std::vector<ContactRow> rows;
  std::vector<PointRow> points;

  explicit ScalarTick(RigidWorld& w) : bodies(w.bodies.size()), motions(w.bodies.size()) {
    for (uint32_t k = 0; k < bodies.size(); ++k)
      if (w.bodies[k].type != BodyType::fixed) motions[k].slot = k;
    for (const uint32_t source : by_colour(w)) {
      const Contact& c = w.contacts.contacts()[source];
      ContactRow& row = rows.emplace_back();
      row.a = c.key.body_a;
      row.b = c.key.body_b;
      row.source = source;
      row.first = uint32_t(points.size());
      row.count = uint32_t(c.count);
      points.resize(points.size() + row.count);
    }
    const SolverContext context{w.bodies, w.contacts.contacts(), w.gravity, w.h, &w.settings, {}};
    const SolverIsland all{bodies, motions, rows, points, {}, 1};
    const double hs = w.h / w.settings.substeps, push_out = w.settings.push_out_speed;
    prepare_rows(context, all, hs);
    for (const ContactRow& row : rows) REQUIRE(!row.spins);
    for (int i = 0; i < w.settings.substeps; ++i) {
      integrate_velocities(context, all, hs);
      warm_start(all);
      solve_rows(all, hs, push_out, true);
      integrate_positions(context, all, hs);
      solve_rows(all, hs, push_out, false);
      sum_impulses(all);
    }
    apply_restitution(context, all);
    store_rows(context, all, hs);
    store_bodies(context, all);
  }
};

/// Of bodies that touch something.
struct Difference {
  double velocity = 0, turning = 0, place = 0, impulse = 0;
  int bodies = 0;  ///< that differ by more than `tight`
};

Difference difference(const RigidWorld& a, const RigidWorld& b, double tight) {
  Difference d;
  for (size_t k = 0; k < a.bodies.size(); ++k) {
    const RigidBody &x = a.bodies[k], &y = b.bodies[k];
    const auto is_of = [&](const Contact& c) { return c.key.body_a == k || c.key.body_b == k; };
    if (std::ranges::none_of(a.contacts.contacts(), is_of)) continue;
    const double v = (x.v - y.v).norm(), w = (x.omega - y.omega).norm();
    d.bodies += v > tight || w > tight;
    d.velocity = std::max(d.velocity, v);
    d.turning = std::max(d.turning, w);
    d.place = std::max({d.place, (x.pose.x - y.pose.x).norm(), x.pose.q.angularDistance(y.pose.q)});
  }
  REQUIRE(a.contacts.size() == b.contacts.size());
  for (size_t k = 0; k < a.contacts.size(); ++k)
    for (int i = 0; i < a.contacts.contacts()[k].count; ++i)
      d.impulse = std::max(d.impulse, (contact_impulse(a.contacts.contacts()[k], i) -
                                       contact_impulse(b.contacts.contacts()[k], i))
                                          .norm());
  return d;
}

/// A second world in the same state.
void copy_state(const RigidWorld& from, RigidWorld& to) {
  to.bodies = from.bodies;
  to.settings = from.settings;
  ByteWriter out;
  from.contacts.save(out);
  ByteReader in(out.bytes());
  REQUIRE(to.contacts.load(in, uint32_t(to.bodies.size())));
}

std::vector<uint64_t> pile_hashes(int threads, int bodies, int ticks) {
  WideWorld w(threads);
  add_mixed_pile(w, bodies);
  std::vector<uint64_t> out;
  for (int k = 0; k < ticks; ++k) {
    w.step();
    if (k % 4 == 3) out.push_back(w.hash());
  }
  return out;
}

}  // namespace

TEST_CASE("a tick of bundles is that of the scalar rows in the same order, to single precision") {
  int compared = 0, bodies = 0, apart = 0;
  for (int round = 0; round < scaled(12, 4); ++round) {
    WideWorld w;
    add_mixed_pile(w, 150, uint64_t(round) + 5);
    w.settings.substeps = round % 2 == 0 ? 4 : 8;
    for (RigidBody& b : w.bodies)
      for (BodyShape& s : b.shapes) {
        s.material.restitution = round % 4 == 3 ? 0.5 : 0;
        s.material.rolling_friction = round % 3 == 2 ? 0.01 : 0;
        s.material.torsional_friction = round % 3 == 2 ? 0.005 : 0;
      }
    w.bodies[0].shapes[0].material.surface_velocity = {round % 3 == 1 ? 1.0 : 0.0, 0, 0};
    w.run(0.8 + 0.1 * round);
    w.find_contacts();
    for (RigidBody& b : w.bodies) {  // what spins faster is left to the scalar rows
      const double most = 0.19 / w.h;
      if (b.omega.norm() > most) b.omega *= most / b.omega.norm();
    }
    RigidWorld other;
    copy_state(w, other);
    w.solve();
    const ScalarTick scalar(other);
    // Speeds are up to 10 m/s and 12 rad/s, impulses up to 1e3 N s, lever arms 0.4 m.
    double strongest = 0;
    for (const Contact& c : other.contacts.contacts())
      for (int i = 0; i < c.count; ++i)
        strongest = std::max(strongest, contact_impulse(c, i).norm());
    // A contact is soft below a gap of zero and rigid above: where the gap is zero to rounding the
    // two may differ, and the bodies around it feel that, in place by a fraction of a
    // millimetre. Of all bodies few are off by more than 1e-4.
    const Difference d = difference(w, other, 1e-4);
    CAPTURE(round);
    bodies += int(w.bodies.size());
    apart += d.bodies;
    CHECK(d.velocity < 2e-2);
    CHECK(d.turning < 2e-1);
    CHECK(d.place < 1e-3);
    CHECK(d.impulse < (d.bodies > 0 ? 1e-2 : 1e-4) * strongest);
    compared += int(scalar.rows.size());
  }
  CHECK(compared > 400);
  CHECK(apart <= bodies / 40);
}

TEST_CASE("bundles conserve momentum") {
  WideWorld w;
  w.gravity.setZero();
  Random r(8);
  double sum = 0;
  for (int i = 0; i < 216; ++i) {
    const Vec3 x{i % 6 * 0.9, i / 6 % 6 * 0.9, i / 36 * 0.9};
    BodyDef d = body(i % 2 ? box(.4, .4, .4) : sphere(.45), x, 0.5, 0.3);
    d.velocity = -3 * (x - Vec3(2.2, 2.2, 2.2)) + Vec3(r.uniform(-1, 1), 0, 0);
    w.add(d);
    sum += w.bodies.back().mass * d.velocity.norm();
  }
  const Vec3 before = w.momentum();
  for (int k = 0; k < 60; ++k) {
    w.step();
    CHECK((w.momentum() - before).norm() < 1e-6 * sum);
  }
  CHECK(w.contacts.size() > 50);
}

TEST_CASE("a box slides as far in every direction, and rests below the angle of friction") {
  const double mu = 0.5, v0 = 4;
  for (const double angle : {0.0, 0.3, 0.8, 2.0, 4.4}) {
    WideWorld w;
    w.floor(mu);
    BodyDef d = body(box(.5, .2, .5), {0, 0.2, 0}, mu);
    d.velocity = {v0 * std::cos(angle), 0, v0 * std::sin(angle)};
    w.add(d);
    w.run(1.5);
    CHECK(w.bodies[1].v.norm() < 1e-4);
    CHECK(w.bodies[1].pose.x.norm() == doctest::Approx(v0 * v0 / (2 * mu * 9.81)).epsilon(0.03));
  }
  WideWorld w;
  const double slope = std::atan(0.45);
  w.gravity = {9.81 * std::sin(slope), -9.81 * std::cos(slope), 0};
  w.floor(mu);
  w.add(body(box(.5, .2, .5), {0, 0.2, 0}, mu));
  w.run(0.5);
  const Vec3 start = w.bodies[1].pose.x;
  w.run(5);
  CHECK((w.bodies[1].pose.x - start).norm() < 1e-4);
}

TEST_CASE("in bundles balls roll, bounce and ride on belts as they should") {
  WideWorld w;
  w.floor();
  w.bodies[0].shapes[0].material.restitution = 0;
  BodyDef slides = body(sphere(.5), {0, .5, 0});
  slides.velocity = {3.5, 0, 0};
  const uint32_t rolling = w.add(slides);
  const uint32_t bouncing = w.add(body(sphere(.25), {10, 1.25, 0}, 0.5, 0.8));
  const uint32_t belt = w.fixed(box(4, .5, 1), {20, 0.5, 0});
  w.bodies[belt].shapes[0].material.surface_velocity = {0, 0, 0.2};
  const uint32_t rider = w.add(body(box(.2, .2, .2), {20, 1.2, -0.5}));
  double apex = 0;
  for (int k = 0; k < 120; ++k) {
    w.step();
    if (k > 40 && k < 80) apex = std::max(apex, w.bodies[bouncing].pose.x.y() - 0.25);
  }
  // Five sevenths of the speed remain when it rolls.
  CHECK(w.bodies[rolling].v.x() == doctest::Approx(2.5).epsilon(0.02));
  CHECK(w.bodies[rolling].omega.z() == doctest::Approx(-5).epsilon(0.02));
  CHECK(apex == doctest::Approx(0.64).epsilon(0.05));
  CHECK(w.bodies[rider].v.z() == doctest::Approx(0.2).epsilon(1e-3));
}

TEST_CASE("every instruction set gives the same bits") {
  const int ticks = scaled(120, 24);
  const std::vector<uint64_t> best = pile_hashes(1, 100, ticks);
  int targets = 0;
  for (int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
    const int64_t target = left & -left;
    CAPTURE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    CHECK(pile_hashes(1, 100, ticks) == best);
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    ++targets;
  }
  CHECK(targets > 0);
}

TEST_CASE("1 to 8 threads give the same bits where colours are shared out" *
          doctest::test_suite("long")) {
  // So many that a colour has several chunks.
  const auto run = [](int threads) {
    WideWorld w(threads);
    w.floor();
    for (int i = 0; i < 2500; ++i)
      w.add(body(i % 3 ? sphere(.25) : box(.25, .25, .25),
                 {i % 25 * .5, .25 + i / 625 * .5, i / 25 % 25 * .5}));
    for (int k = 0; k < 8; ++k) w.step();
    return w.hash();
  };
  const uint64_t one = run(1);
  for (int threads = 2; threads <= 8; ++threads) CHECK(run(threads) == one);
}
