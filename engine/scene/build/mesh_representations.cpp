#include "engine/scene/build/mesh_representations.hpp"

#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/core/elapsed.hpp"
#include "engine/core/stop.hpp"
#include "engine/geometry/constructions/surface_samples.hpp"
#include "engine/geometry/distance_field/distance_field.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/mesh_topology.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"
#include "engine/scene/description/shape.hpp"

#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr size_t error_samples = 2000, timed_queries = 500;
using Clock = std::chrono::steady_clock;

size_t bytes_of_mesh(const TriangleMesh& mesh) {
  return mesh.vertices.size() * sizeof(Vec3) + mesh.triangles.size() * sizeof(mesh.triangles[0]);
}

size_t bytes_of_shape(const Shape& shape) {
  if (!made_of_mesh(shape.type())) {
    size_t numbers = 0;
    for (const ShapeParameter& p : shape_entry(shape.type()).parameters)
      numbers += p.vector ? 3 : 1;
    return numbers * sizeof(double);
  }
  const MeshSurface& surface = shape.polyhedral()->surface();
  size_t out = bytes_of_mesh(*surface.mesh);
  if (shape.is_mesh()) out += surface.tree->state_bytes();
  if (shape.field()) out += shape.field()->report().bytes;
  return out;
}

/// Error of the zero level set of a field: points of it are found by projection of points of the
/// mesh; and how far points of the mesh are outside of it.
SolidError field_error_of(const DistanceField& field, const Hierarchy& surface) {
  SolidError out;
  const SurfaceSamples on_surface(surface.mesh());
  for (size_t n = 1; n <= error_samples && !stop_requested(); ++n) {
    const Vec3 p = on_surface(n).point;
    out.missing = std::max(out.missing, field.value(p));
    const Vec3 foot = field.foot(p).point;
    const auto near = surface.closest(foot, std::numeric_limits<double>::infinity());
    const double d = near ? std::sqrt(near->squared_distance) : 0;
    if (d > out.added && point_in_object(foot, surface).side == PointSide::outside) out.added = d;
  }
  return out;
}

/// Mean time to compute the contacts of a ball of 1/50 of the size, at positions around the
/// surface.
double time_queries(const std::vector<PlacedShape>& shapes, const TriangleMesh& mesh, double size) {
  const auto ball = make_shape(ball_def(size / 50));
  if (!ball) return 0;
  const SurfaceSamples on_surface(mesh);
  const ContactQuery query(0);
  std::vector<Manifold> contacts;
  std::vector<Aabb> boxes;
  for (const PlacedShape& s : shapes) boxes.push_back(s.shape->bounds(s.pose));
  const auto ask = [&](size_t n) {
    const Pose at{on_surface(n).point, Quat::Identity()};
    const Aabb box = (*ball)->bounds(at);
    contacts.clear();
    for (size_t k = 0; k < shapes.size(); ++k)
      if (boxes[k].overlaps(box))
        collide(*shapes[k].shape, shapes[k].pose, **ball, at, query, contacts);
  };
  for (size_t n = 1; n <= timed_queries / 10; ++n) ask(n);
  const auto start = Clock::now();
  for (size_t n = 1; n <= timed_queries && !stop_requested(); ++n) ask(n);
  return 1e9 * seconds_since(start) / double(timed_queries);
}

void measure(RepresentationFacts& out, const Hierarchy& surface, bool closed, double volume) {
  std::vector<PlacedShape> placed;
  double sum = 0;
  for (const MeshPart& part : out.parts.parts) {
    const auto shape = make_shape(part.shape);
    if (!shape) {
      out.refusal = shape.error().message;
      return;
    }
    placed.push_back({*shape, part.pose});
    out.bytes += bytes_of_shape(**shape);
    const auto mass = (*shape)->mass_properties();
    if (mass) sum += mass->mass;
  }
  out.words = placed.size() == 1 ? placed[0].shape->words()
                                 : fmt::format("{} convex pieces", placed.size());
  if (const DistanceField* field = placed[0].shape->field())
    out.error = field_error_of(*field, surface);
  else if (placed[0].shape->convex())
    out.error = solid_error(placed, surface, closed, error_samples);
  if (volume > 0) out.volume_ratio = sum / volume;
  out.query_ns = time_queries(placed, surface.mesh(), surface.bounds().extent().norm());
}

}  // namespace

std::vector<RepresentationFacts> measure_representations(
    const std::shared_ptr<const TriangleMesh>& mesh, const MeshRepresentation& base) {
  const AabbTree surface(mesh);
  const bool closed = build_topology(*mesh).closed_and_oriented();
  const auto mass = mesh_mass(*mesh);
  std::vector<RepresentationFacts> out(mesh_mode_count);
  for (size_t k = 0; k < out.size(); ++k) {
    RepresentationFacts& facts = out[k];
    MeshRepresentation how = base;
    facts.mode = how.mode = MeshMode(k);
    const auto start = Clock::now();
    auto parts = mesh_parts(mesh, how);
    facts.seconds = seconds_since(start);
    if (!parts) {
      facts.refusal = parts.error().message;
      continue;
    }
    facts.parts = *std::move(parts);
    measure(facts, surface, closed, mass ? mass->mass : 0);
  }
  return out;
}

std::string representations_text(const std::vector<RepresentationFacts>& all) {
  std::string out =
      "  collides as         pieces      bytes   added [m]  missing [m]  volume  query [ns]\n";
  for (const RepresentationFacts& f : all) {
    if (!f.refusal.empty()) {
      out += fmt::format("    {:<17}none: {}\n", enum_name(f.mode), f.refusal);
      continue;
    }
    out +=
        fmt::format("    {:<17}{:>7}{:>11}{:>12.3g}{:>13.3g}{:>8}{:>12.0f}\n", enum_name(f.mode),
                    f.parts.parts.size(), f.bytes, f.error.added, f.error.missing,
                    f.volume_ratio > 0 ? fmt::format("{:.3f}", f.volume_ratio) : "-", f.query_ns);
  }
  return out;
}

}  // namespace tumble
