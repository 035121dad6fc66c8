// The first contact of two moving shapes by every method that applies, and of convex pairs by FCL's
// conservative advancement: the same random pairs for all. Answers are the number of contacts found
// (FCL ends at bounds on time, not on the gap). An argument chooses the families that contain it.
#include "engine/collision/shapes/convex_hull.hpp"
#include "engine/collision/time_of_contact.hpp"
#include "engine/core/random.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/math/dense.hpp"
#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"
#include "tests/bench/contest.hpp"

#include <cmath>
#include <cstring>

#include <fcl/fcl.h>

using namespace tumble;

namespace {

constexpr double contact_tolerance = 1e-4, tick = 1.0 / 60;

Vec3 random_way(Random& r) {
  const double z = r.uniform(-1, 1), phi = r.uniform(0, 2 * det::pi), s = std::sqrt(1 - z * z);
  return {s * det::cos(phi), s * det::sin(phi), z};
}

Quat random_turn(Random& r) {
  const double a = r.uniform(), b = r.uniform(0, 2 * det::pi), c = r.uniform(0, 2 * det::pi);
  return Quat(std::sqrt(1 - a) * det::sin(b), std::sqrt(1 - a) * det::cos(b),
              std::sqrt(a) * det::sin(c), std::sqrt(a) * det::cos(c));
}

std::shared_ptr<const Shape> made(const ShapeDef& def) {
  return make_shape(def).value();
}

std::shared_ptr<const Shape> surface(TriangleMesh m) {
  return made({.type = ShapeType::triangle_mesh,
               .mesh = std::make_shared<const TriangleMesh>(std::move(m))});
}

std::shared_ptr<const Shape> round_hull(Random& r, int n, const Vec3& axes) {
  auto points = std::make_shared<TriangleMesh>();
  for (int i = 0; i < n; ++i) points->vertices.push_back(random_way(r).cwiseProduct(axes));
  return made({.type = ShapeType::convex_hull, .mesh = points});
}

struct Flight {
  std::shared_ptr<const Shape> a, b;
  Motion ma, mb;
};

/// The same shape for FCL, and how its frame lies in ours. Null for meshes.
struct PeerShape {
  std::shared_ptr<fcl::CollisionGeometry<double>> geometry;
  Quat turn = Quat::Identity();
};

PeerShape peer_of(const Shape& s) {
  const ShapeDef& d = s.def();
  if (s.type() == ShapeType::box)
    return {std::make_shared<fcl::Box<double>>(fcl::Vector3<double>(2 * dense(d.half_extents)))};
  if (s.type() == ShapeType::sphere) return {std::make_shared<fcl::Sphere<double>>(d.radius)};
  if (s.type() == ShapeType::capsule)  // along z
    return {std::make_shared<fcl::Capsule<double>>(d.radius, d.height),
            rotation_between(Vec3::UnitZ(), Vec3::UnitY())};
  if (s.type() != ShapeType::convex_hull) return {};
  const ConvexPolyhedron& p = static_cast<const ConvexHullShape&>(s).polyhedron();
  const auto faces = std::make_shared<std::vector<int>>();
  for (size_t f = 0; f < p.face_count(); ++f) {
    faces->push_back(int(p.face(f).size()));
    for (uint32_t v : p.face(f)) faces->push_back(int(v));
  }
  const auto corners = std::make_shared<std::vector<fcl::Vector3d>>();
  for (const Vec3& v : p.vertices) corners->push_back(dense(v));
  return {std::make_shared<fcl::Convex<double>>(corners, int(p.face_count()), faces)};
}

/// Whether FCL's conservative advancement finds a contact.
bool meet_by_fcl(const PeerShape& a, const PeerShape& b, const Flight& f) {
  const auto at = [](const Motion& m, double t, const PeerShape& s) {
    const Pose pose = m.pose(t);
    fcl::Transform3<double> out = fcl::Transform3<double>::Identity();
    out.linear() = dense((pose.q * s.turn).toRotationMatrix());
    out.translation() = dense(pose.x);
    return out;
  };
  const fcl::ContinuousCollisionRequest<double> request(1000, contact_tolerance, fcl::CCDM_LINEAR,
                                                        fcl::GST_LIBCCD,
                                                        fcl::CCDC_CONSERVATIVE_ADVANCEMENT);
  fcl::ContinuousCollisionResult<double> result;
  fcl::continuousCollide(a.geometry.get(), at(f.ma, 0, a), at(f.ma, tick, a), b.geometry.get(),
                         at(f.mb, 0, b), at(f.mb, tick, b), request, result);
  return result.is_collide;
}

struct Family {
  const char* name;
  std::vector<Flight> flights;
};

/// B flies at A from `distance` in random attitudes, at a speed [m/s] and a spin [rad/s].
Family family(const char* name, const std::shared_ptr<const Shape>& a,
              const std::shared_ptr<const Shape>& b, double distance, double speed, double spin,
              int count) {
  Random r(5);
  Family f{name, {}};
  for (int i = 0; i < count; ++i) {
    const Vec3 way = random_way(r), aside = 0.2 * random_way(r);
    Motion ma = Motion::at_rest({Vec3::Zero(), random_turn(r)}, 0, tick), mb = ma;
    mb.start = {distance * way, random_turn(r)};
    mb.velocity = -speed * (way + aside);
    mb.omega = spin * random_way(r);
    f.flights.push_back({a, b, ma, mb});
  }
  return f;
}

}  // namespace

int main(int argc, char** argv) {
  Random r(7);
  const auto small = round_hull(r, 16, {0.5, 0.4, 0.3}),
             large = round_hull(r, 256, {0.5, 0.5, 0.4});
  const auto brick = made({.type = ShapeType::box, .half_extents = {0.3, 0.2, 0.1}});
  const auto ball = made({.type = ShapeType::sphere, .radius = 0.3});
  const auto rod = made({.type = ShapeType::capsule, .radius = 0.02, .height = 1});
  const auto torus = surface(make_mesh::torus(0.4, 0.1, 24, 12));
  const auto shell = surface(make_mesh::box({0.5, 0.5, 5e-5}));
  const auto globe = surface(make_mesh::icosphere(0.5, 3));
  const std::vector<Family> families{
      family("hull 16 - hull 16, slow", small, small, 1.0, 6, 3, 1000),
      family("hull 16 - hull 16, fast", small, small, 1.6, 100, 60, 1000),
      family("hull 256 - hull 256, slow", large, large, 1.05, 6, 3, 400),
      family("hull 256 - hull 256, fast", large, large, 1.6, 100, 60, 400),
      family("box - box, slow", brick, brick, 0.6, 6, 3, 1000),
      family("box - box, fast", brick, brick, 1.0, 100, 60, 1000),
      family("ball - ball", ball, ball, 1.5, 100, 60, 1000),
      family("capsule - box, fast", brick, rod, 1.5, 100, 60, 1000),
      family("capsule - shell, fast", shell, rod, 1.5, 1000, 300, 50),
      family("box - torus, slow", torus, brick, 0.75, 3, 3, 50),
      family("box - torus, fast", torus, brick, 1.2, 100, 60, 50),
      family("torus - torus, slow", torus, torus, 1.0, 3, 3, 30),
      family("torus - torus, fast", torus, torus, 1.5, 100, 60, 30),
      family("globe - torus, fast", globe, torus, 1.5, 100, 20, 30),
      family("shell - torus, fast", shell, torus, 1.5, 1000, 100, 30),
  };
  for (const Family& f : families) {
    if (argc > 1 && !std::strstr(f.name, argv[1])) continue;
    std::vector<bench::Candidate> candidates;
    for (const ContactTimeMethod& method : all_contact_time_methods()) {
      for (const bool v_clip : {false, true}) {
        TimeOfContactOptions options;
        options.method = &method;
        options.v_clip = v_clip;
        const Flight& first = f.flights.front();
        if (v_clip && !(first.a->polyhedral() && first.a->convex() && first.b->polyhedral()))
          continue;
        const TimeOfContact probe =
            time_of_contact(*first.a, first.ma, *first.b, first.mb, contact_tolerance, options);
        if (method.name != "automatic" && probe.method != method.name) continue;
        candidates.push_back(
            {std::string(method.name) + (v_clip ? ", v_clip" : ""), [&f, options] {
               int hits = 0;
               for (const Flight& x : f.flights) {
                 hits += time_of_contact(*x.a, x.ma, *x.b, x.mb, contact_tolerance, options).hit();
               }
               return double(hits);
             }});
      }
    }
    const PeerShape a = peer_of(*f.flights.front().a), b = peer_of(*f.flights.front().b);
    if (a.geometry && b.geometry) {
      candidates.push_back({"FCL, conservative advancement", [&f, &a, &b] {
                              int hits = 0;
                              for (const Flight& x : f.flights) hits += meet_by_fcl(a, b, x);
                              return double(hits);
                            }});
    }
    const std::vector<bench::Timing> timings = bench::contest(candidates, 5);
    std::printf("%s\n", f.name);
    for (size_t k = 0; k < candidates.size(); ++k) {
      std::printf("  %-36s %9.3f us   %g of %zu meet\n", candidates[k].name.c_str(),
                  1e3 * timings[k].cpu / double(f.flights.size()), timings[k].answer,
                  f.flights.size());
    }
  }
}
