// Convex decomposition. The exact one against CGAL's convex_decomposition_3 on Nef polyhedra (exact
// arithmetic throughout): pieces and time, with and without what turns the mesh into such a
// polyhedron; the answer is the number of pieces, and the volumes of both add up to the mesh's. The
// bars: .7 of CGAL's pieces in half its time.
//
// The approximate one beside what CoACD (threshold .05 of half the longest side) and V-HACD give
// for the same two meshes. Their figures are from a run of theirs, not of this program: hull volume
// over mesh volume and pieces hold anywhere, milliseconds only on a like machine. The bar: CoACD's
// ratio in a tenth of its time.
#include "engine/core/random.hpp"
#include "engine/geometry/decomposition/convex_decomposition.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/bench/contest.hpp"

#include <cmath>
#include <memory>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/Polyhedron_incremental_builder_3.h>
#include <CGAL/convex_decomposition_3.h>

using namespace tumble;

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Polyhedron = CGAL::Polyhedron_3<Kernel>;
using Nef = CGAL::Nef_polyhedron_3<Kernel>;

struct Subject {
  const char* name;
  TriangleMesh mesh;
  double coacd_ratio, coacd_ms;  ///< hull volume over mesh volume; 0 where nobody ran it
  int coacd_pieces;
};

/// Six rings of 16 corners, straight walls outside and inside, a thick bottom: 188 triangles.
TriangleMesh cup() {
  const double profile[6][2] = {{0.3, 0},   {0.375, 0.4},  {0.45, 0.8},
                                {0.4, 0.8}, {0.325, 0.44}, {0.25, 0.08}};
  constexpr uint32_t n = 16;
  TriangleMesh m;
  for (const auto& p : profile)
    for (uint32_t i = 0; i < n; ++i) {
      const double a = 2 * 3.14159265358979323846 * i / n;
      m.vertices.push_back({p[0] * std::cos(a), p[1], p[0] * std::sin(a)});
    }
  for (uint32_t r = 0; r < 5; ++r)
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t a = r * n + i, b = r * n + (i + 1) % n;
      m.triangles.push_back({a, a + n, b});
      m.triangles.push_back({b, a + n, b + n});
    }
  for (uint32_t i = 1; i + 1 < n; ++i) {
    m.triangles.push_back({0, i, i + 1});
    m.triangles.push_back({5 * n, 5 * n + i + 1, 5 * n + i});
  }
  return m;
}

/// Every corner of a ball drawn in by chance: most edges are reflex, no two in one plane.
TriangleMesh spiky_ball() {
  Random random(7);
  TriangleMesh mesh = make_mesh::icosphere(1, 2);
  for (Vec3& v : mesh.vertices) v *= random.uniform(0.6, 1);
  return mesh;
}

struct Builder : CGAL::Modifier_base<Polyhedron::HalfedgeDS> {
  explicit Builder(const TriangleMesh& m) : mesh(m) {}
  void operator()(Polyhedron::HalfedgeDS& out) override {
    CGAL::Polyhedron_incremental_builder_3<Polyhedron::HalfedgeDS> b(out);
    b.begin_surface(mesh.vertices.size(), mesh.triangles.size());
    for (const Vec3& v : mesh.vertices) b.add_vertex(Kernel::Point_3(v.x(), v.y(), v.z()));
    for (const Triangle& t : mesh.triangles) b.add_facet(t.begin(), t.end());
    b.end_surface();
  }
  const TriangleMesh& mesh;
};

Nef nef_of(const TriangleMesh& mesh) {
  Polyhedron p;
  Builder builder(mesh);
  p.delegate(builder);
  return Nef(p);
}

double pieces_of(const Nef& cut) {
  size_t count = 0;
  auto v = cut.volumes_begin();
  for (++v; v != cut.volumes_end(); ++v) count += v->mark() ? 1 : 0;
  return double(count);
}

double volume_of(Nef& cut) {
  double sum = 0;
  auto v = cut.volumes_begin();
  for (++v; v != cut.volumes_end(); ++v) {
    if (!v->mark()) continue;
    Polyhedron piece;
    cut.convert_inner_shell_to_polyhedron(v->shells_begin(), piece);
    CGAL::Polygon_mesh_processing::triangulate_faces(piece);
    sum += CGAL::to_double(CGAL::Polygon_mesh_processing::volume(piece));
  }
  return sum;
}

void exact(const Subject& s) {
  const Nef whole = nef_of(s.mesh);
  Nef cut;
  ConvexDecomposition ours;
  bench::report(
      std::string(s.name) + ", " + std::to_string(s.mesh.triangles.size()) + " triangles: pieces",
      {{"CGAL, from its polyhedron",
        [&] {
          cut = whole;
          CGAL::convex_decomposition_3(cut);
          return pieces_of(cut);
        }},
       {"CGAL, from the mesh",
        [&] {
          cut = nef_of(s.mesh);
          CGAL::convex_decomposition_3(cut);
          return pieces_of(cut);
        }},
       {"tumble",
        [&] {
          ours = *decompose_exactly(s.mesh);
          return double(ours.pieces.size());
        }}},
      3);
  const double volume = ours.mesh_volume;
  std::printf("  volumes off by: CGAL %.1e, tumble %.1e of the mesh's\n",
              std::fabs(volume_of(cut) / volume - 1), std::fabs(ours.hull_volume / volume - 1));
}

void approximate(const Subject& s) {
  const AabbTree surface(std::make_shared<const TriangleMesh>(s.mesh));
  ApproximateDecompositionOptions options;
  options.concavity = 0.05 * surface.bounds().extent().maxCoeff() / 2;
  ConvexDecomposition ours;
  bench::report("  approximate, within " + std::to_string(options.concavity) + " m",
                {{"tumble",
                  [&] {
                    ours = *decompose_approximately(surface, options);
                    return double(ours.pieces.size());
                  }}},
                3);
  std::printf("  hull volume over mesh volume %.4f with %zu pieces, added %.4f, missing %.4f m\n",
              ours.hull_volume / ours.mesh_volume, ours.pieces.size(), ours.added, ours.missing);
  if (s.coacd_pieces > 0)
    std::printf("  CoACD, elsewhere: %.3f with %d pieces in %.0f ms\n", s.coacd_ratio,
                s.coacd_pieces, s.coacd_ms);
}

}  // namespace

int main() {
  for (const Subject& s : {Subject{"cup", cup(), 1.025, 4383, 19},
                           {"torus", make_mesh::torus(1, 0.4, 24, 12), 1.081, 2544, 12},
                           {"spiky ball", spiky_ball(), 0, 0, 0}}) {
    exact(s);
    approximate(s);
  }
}
