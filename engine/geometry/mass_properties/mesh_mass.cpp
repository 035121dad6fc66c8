#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/mesh_topology.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr size_t named_edges = 5;

/// "12 open edges: 3-4 5-6 ..." with the vertices of the first few.
template <class Pick>
std::string name_edges(const MeshTopology& topology, size_t count, const char* kind,
                       const Pick& pick) {
  std::string text = fmt::format("{} {} edge{} (vertices", count, kind, count == 1 ? "" : "s");
  size_t named = 0;
  for (const MeshEdge& e : topology.edges) {
    if (!pick(e)) continue;
    if (named++ == named_edges) break;
    text += fmt::format(" {}-{}", e.vertices[0], e.vertices[1]);
  }
  return text + (count > named_edges ? " ...)" : ")");
}

Status check_closed(const MeshTopology& topology) {
  const auto fault = [](std::string message, const char* cure) {
    return Error{ErrorCode::invalid_argument, std::move(message), {}, cure};
  };
  if (topology.non_manifold_edges > 0) {
    return fault("the mesh has no defined inside: " +
                     name_edges(topology, topology.non_manifold_edges, "non-manifold",
                                [](const MeshEdge& e) { return e.face_count > 2; }),
                 "clean the mesh, split it into parts, or use its convex hull");
  }
  if (topology.open_edges > 0) {
    return fault("the mesh is not closed: " +
                     name_edges(topology, topology.open_edges, "open",
                                [](const MeshEdge& e) { return e.face_count == 1; }),
                 "weld its vertices, fill its holes, or use its convex hull");
  }
  if (topology.misoriented_edges > 0) {
    return fault("the mesh is not consistently oriented: " +
                     name_edges(topology, topology.misoriented_edges, "misoriented",
                                [](const MeshEdge& e) {
                                  return e.face_count == 2 && e.bend == EdgeBend::open;
                                }),
                 "orient its triangles, or use its convex hull");
  }
  return {};
}

}  // namespace

MassProperties mesh_integrals(const TriangleMesh& mesh, double density) {
  const Aabb box = bounds(mesh);
  if (box.empty()) return {};
  const Vec3 origin = box.centre();
  double volume6 = 0;
  Vec3 moment24 = Vec3::Zero();
  Mat3 second120 = Mat3::Zero();
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.corner(t, 0) - origin, b = mesh.corner(t, 1) - origin,
               c = mesh.corner(t, 2) - origin;
    // From two sides, so that small triangles lose nothing to cancellation.
    const double d = a.dot((b - a).cross(c - a));
    const Vec3 s = a + b + c;
    volume6 += d;
    moment24 += d * s;
    second120 +=
        d * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  MassProperties out;
  const double volume = volume6 / 6;
  out.mass = density * volume;
  if (volume == 0) {
    out.centre = origin;
    return out;
  }
  const Vec3 centre = moment24 / (24 * volume);
  const Mat3 second = second120 / 120 - volume * centre * centre.transpose();
  out.centre = origin + centre;
  out.inertia = density * (second.trace() * Mat3::Identity() - second);
  return out;
}

Result<MassProperties> mesh_mass(const TriangleMesh& mesh, double density) {
  if (const Status ok = validate(mesh); !ok) return ok.error();
  const MeshTopology topology = build_topology(mesh);
  if (const Status ok = check_closed(topology); !ok) return ok.error();
  const MassProperties out = mesh_integrals(mesh, 1);
  const double extent = bounds(mesh).extent().maxCoeff();
  if (std::fabs(out.mass) <= 1e-14 * extent * extent * extent) {
    return Error{ErrorCode::invalid_argument,
                 fmt::format("the mesh encloses no volume ({} m^3 within {} m)", out.mass, extent),
                 {},
                 "give it thickness"};
  }
  if (out.mass < 0) {
    return Error{ErrorCode::invalid_argument,
                 fmt::format("the mesh is inside-out: its volume is {} m^3", out.mass),
                 {},
                 "reverse the order of the corners of every triangle"};
  }
  return out.times(density);
}

MassProperties polyhedron_mass(const ConvexPolyhedron& polyhedron, double density) {
  return mesh_integrals(to_mesh(polyhedron), density);
}

}  // namespace tumble
