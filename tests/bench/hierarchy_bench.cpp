// Hierarchies over triangle meshes against FCL (OBB, RSS, AABB) and Embree; CGAL's exact predicates
// as the judge of the count of intersecting pairs. Torus knots of 5,000 and 70,000 triangles,
// longest side 1, the second one turned at random and moved by d in a random direction, eight poses
// each.
#include "engine/core/random.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"
#include "tests/bench/contest.hpp"
#include "tests/bench/peer_meshes.hpp"
#include "tests/geometry/draws.hpp"

#include <cmath>

using namespace tumble;

namespace {

using MeshPtr = std::shared_ptr<const TriangleMesh>;

/// C(t) = ((1 + .4 cos 3t) cos 2t, (1 + .4 cos 3t) sin 2t, -.4 sin 3t), tube .12, along its own
/// normals; centred, longest side 1.
TriangleMesh torus_knot(int along, int around) {
  const double tau = 2 * 3.14159265358979323846;
  const auto curve = [&](double t) {
    const double r = 1 + 0.4 * std::cos(3 * t);
    return Vec3(r * std::cos(2 * t), r * std::sin(2 * t), -0.4 * std::sin(3 * t));
  };
  TriangleMesh mesh;
  for (int i = 0; i < along; ++i) {
    const double t = tau * i / along, h = 1e-4;
    const Vec3 tangent = (curve(t + h) - curve(t - h)).normalized();
    const Vec3 bend = curve(t + h) - 2 * curve(t) + curve(t - h);
    const Vec3 n = (bend - tangent * tangent.dot(bend)).normalized(), b = tangent.cross(n);
    for (int j = 0; j < around; ++j) {
      const double a = tau * j / around;
      mesh.vertices.push_back(curve(t) + 0.12 * (std::cos(a) * n + std::sin(a) * b));
    }
  }
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < around; ++j) {
      const auto at = [&](int p, int q) { return uint32_t(p % along * around + q % around); };
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  const Aabb box = bounds(mesh);
  for (Vec3& v : mesh.vertices) v = (v - box.centre()) / box.extent().maxCoeff();
  return mesh;
}

std::vector<Pose> poses(double d) {
  Random r(42);
  std::vector<Pose> out;
  for (int i = 0; i < 8; ++i) {
    const Quat q = draws::rotation(r);
    out.push_back({d * draws::direction(r), q});
  }
  return out;
}

std::unique_ptr<Hierarchy> build(const char* name, const MeshPtr& mesh) {
  for (const HierarchyKind& kind : all_hierarchies()) {
    if (kind.name == name) return kind.build(mesh);
  }
  std::abort();
}

std::vector<const char*> tree_kinds() {
  std::vector<const char*> out;
  for (const HierarchyKind& kind : all_hierarchies()) {
    if (kind.name != "brute_force") out.push_back(kind.name.data());
  }
  return out;
}

void build_times(const std::string& name, const MeshPtr& mesh) {
  std::vector<bench::Candidate> contest = {
      {"FCL OBB", [&] { return double(peers::FclModel<fcl::OBBd>(*mesh).bytes()); }},
      {"FCL AABB", [&] { return double(peers::FclModel<fcl::AABBd>(*mesh).bytes()); }}};
  for (const char* kind : tree_kinds()) {
    contest.push_back({kind, [&mesh, kind] { return double(build(kind, mesh)->state_bytes()); }});
  }
  const auto timings = bench::report(name + ": build (answer: bytes)", contest, 5);
  for (size_t i = 2; i < timings.size(); ++i) {
    std::printf("  %-28s %6.1f bytes a triangle, %.3f x FCL AABB (cpu)\n", contest[i].name.c_str(),
                timings[i].answer / double(mesh->triangles.size()),
                timings[i].cpu / timings[1].cpu);
  }
}

using Trees = std::vector<std::unique_ptr<Hierarchy>>;

std::string title(const std::string& mesh, const char* what, double d) {
  char text[100];
  std::snprintf(text, sizeof text, "%s: %s of 8 poses, d = %g", mesh.c_str(), what, d);
  return text;
}

/// Sum over the poses of query(pose).
template <class Query>
double over(const std::vector<Pose>& all, const Query& query) {
  double sum = 0;
  for (const Pose& pose : all) sum += double(query(pose));
  return sum;
}

void all_pairs(const std::string& name, const peers::FclModel<fcl::OBBd>& peer, const Trees& trees,
               double d) {
  const auto at = poses(d);
  std::vector<bench::Candidate> all = {
      {"FCL OBB", [&] { return over(at, [&](const Pose& p) { return peer.pairs(p); }); }}};
  for (const auto& tree : trees) {
    all.push_back({std::string(tree->name()), [&] {
                     std::vector<TriangleIds> out;
                     return over(at, [&](const Pose& p) {
                       out.clear();
                       tree->pairs(*tree, p, 0, out);
                       return out.size();
                     });
                   }});
  }
  bench::report(title(name, "all pairs", d), all);
  for (const auto& tree : trees) {
    HierarchyStatistics cost;
    std::vector<TriangleIds> out;
    for (const Pose& p : at) tree->pairs(*tree, p, 0, out, &cost);
    std::printf("    %-12s %9zu node tests, %8zu triangle tests\n", tree->name().data(),
                cost.node_tests, cost.triangle_tests);
  }
}

void first_hit(const std::string& name, const peers::FclModel<fcl::OBBd>& peer, const Trees& trees,
               double d) {
  const auto at = poses(d);
  std::vector<bench::Candidate> all = {
      {"FCL OBB", [&] { return over(at, [&](const Pose& p) { return peer.pairs(p, 1) > 0; }); }}};
  for (const auto& tree : trees) {
    all.push_back({std::string(tree->name()), [&] {
                     return over(at, [&](const Pose& p) { return tree->intersects(*tree, p); });
                   }});
  }
  bench::report(title(name, "first hit", d), all, 51);
}

void distances(const std::string& name, const peers::FclModel<fcl::RSSd>& peer, const Trees& trees,
               double d) {
  const auto at = poses(d);
  std::vector<bench::Candidate> all = {
      {"FCL RSS", [&] { return over(at, [&](const Pose& p) { return peer.distance(p); }); }}};
  for (const auto& tree : trees) {
    all.push_back({std::string(tree->name()), [&] {
                     return over(at, [&](const Pose& p) {
                       return std::sqrt(
                           tree->distance(*tree, p, std::numeric_limits<double>::infinity())
                               ->squared_distance);
                     });
                   }});
  }
  bench::report(title(name, "distance", d), all);
  for (const auto& tree : trees) {
    HierarchyStatistics cost;
    for (const Pose& p : at) tree->distance(*tree, p, 1e9, &cost);
    std::printf("    %-12s %9zu node tests, %8zu triangle tests\n", tree->name().data(),
                cost.node_tests, cost.triangle_tests);
  }
}

/// CGAL's exact predicates as the judge of one pose.
void judge(const std::string& name, const MeshPtr& mesh, const Trees& trees, double d) {
  const auto at = poses(d);
  const double expected = over(at, [&](const Pose& p) { return peers::cgal_pairs(*mesh, p); });
  for (const auto& tree : trees) {
    std::vector<TriangleIds> out;
    for (const Pose& p : at) tree->pairs(*tree, p, 0, out);
    std::printf("%s, d = %g, %s: %zu pairs, CGAL %.0f: %s\n", name.c_str(), d, tree->name().data(),
                out.size(), expected, double(out.size()) == expected ? "equal" : "DIFFERENT");
  }
}

void rays(const std::string& name, const MeshPtr& mesh, const Trees& trees) {
  Random r(7);
  std::vector<Ray> all_rays;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 from = draws::direction(r) * 1.5;
    all_rays.push_back({from, draws::in_box(r, 0.5) - from});
  }
  const peers::EmbreeScene embree(*mesh);
  std::vector<bench::Candidate> all = {{"Embree", [&] {
                                          double hits = 0;
                                          for (const Ray& ray : all_rays) hits += embree.hits(ray);
                                          return hits;
                                        }}};
  for (const auto& tree : trees) {
    all.push_back({std::string(tree->name()), [&] {
                     double hits = 0;
                     for (const Ray& ray : all_rays) {
                       hits += tree->ray(ray, std::numeric_limits<double>::infinity()).has_value();
                     }
                     return hits;
                   }});
  }
  bench::report(name + ": 20,000 rays, one at a time", all, 5);
}

/// Whether a part (build, pairs, first, distance, rays, judge) was asked for; all without
/// arguments.
struct Parts {
  std::vector<std::string> names;
  bool operator()(const std::string& name) const {
    return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
  }
};

void mesh_queries(const std::string& name, const MeshPtr& mesh, const Parts& wanted) {
  const peers::FclModel<fcl::OBBd> obb(*mesh);
  const peers::FclModel<fcl::RSSd> rss(*mesh);
  Trees trees;
  for (const char* kind : tree_kinds()) trees.push_back(build(kind, mesh));
  for (double d : {0.05, 0.3, 0.6, 0.9}) {
    if (wanted("pairs")) all_pairs(name, obb, trees, d);
    if (wanted("first")) first_hit(name, obb, trees, d);
    if (wanted("judge")) judge(name, mesh, trees, d);
  }
  for (double d : {1.5, 2.0}) {
    if (wanted("distance")) distances(name, rss, trees, d);
  }
  if (wanted("rays")) rays(name, mesh, trees);
}

}  // namespace

int main(int argc, char** argv) {
  const Parts wanted{{argv + 1, argv + argc}};
  const auto small = std::make_shared<const TriangleMesh>(torus_knot(250, 10));
  const auto large = std::make_shared<const TriangleMesh>(torus_knot(1000, 35));
  if (wanted("build")) build_times("knot 70k", large);
  mesh_queries("knot 5k", small, wanted);
  mesh_queries("knot 70k", large, wanted);
}
