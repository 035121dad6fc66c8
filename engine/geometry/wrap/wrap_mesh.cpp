#include "engine/geometry/wrap/wrap_mesh.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/watched.hpp"
#include "engine/geometry/constructions/surface_samples.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/isosurface/marching_tetrahedra.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"
#include "engine/geometry/wrap/enclosed_mesh.hpp"
#include "engine/geometry/wrap/fit_wrap.hpp"
#include "engine/geometry/wrap/outside_grid.hpp"
#include "engine/geometry/wrap/simplify_wrap.hpp"
#include "engine/geometry/wrap/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr size_t measured_points = 4000;

Error bad_wrap(std::string message, std::string cure = {}) {
  return {ErrorCode::invalid_argument, std::move(message), {}, std::move(cure)};
}

Status check_wrap(const TriangleMesh& mesh, const WrapOptions& o) {
  if (Status s = validate(mesh); !s) return s.error();
  for (const auto& [name, value] : {std::pair{"gap", o.gap},
                                    {"offset", o.offset},
                                    {"cell", o.cell},
                                    {"tolerance", o.tolerance}})
    if (!(value >= 0) || !std::isfinite(value))
      return bad_wrap(fmt::format("{} of a wrap must be >= 0 m, got {}", name, value));
  return {};
}

double distance_from(const Hierarchy& surface, const Vec3& p) {
  const auto near = surface.closest(p, std::numeric_limits<double>::infinity());
  return near ? std::sqrt(near->squared_distance) : 0;
}

/// Calls f for vertices of a mesh, at most about 2 measured_points, and for points of its surface.
template <class F>
void each_measured_point(const TriangleMesh& mesh, const F& f) {
  const size_t stride = std::max<size_t>(1, mesh.vertices.size() / measured_points);
  for (size_t n = 0; n < mesh.vertices.size() && !stop_requested(); n += stride)
    f(mesh.vertices[n]);
  const SurfaceSamples samples(mesh);
  for (size_t n = 1; n <= measured_points && !stop_requested(); ++n) f(samples(n).point);
}

/// The surface of a grid.
Result<TriangleMesh> surface_of(const OutsideGrid& grid, const WrapOptions& o) {
  // A closed surface has about two triangles for each vertex (Euler). With larger cells it stands
  // farther off and is larger itself, which the size that is named allows for.
  const double triangles = 2 * double(grid.cut_edges());
  if (stop_requested()) return stopped_error();
  if (triangles > double(o.max_triangles))
    return bad_wrap(
        fmt::format("a wrap with cells of {:.3g} m would have {:.3g} triangles, at most {} are "
                    "allowed",
                    o.cell, triangles, o.max_triangles),
        fmt::format("cells of {:.2g} m would do",
                    1.3 * o.cell * std::sqrt(triangles / double(o.max_triangles))));
  TriangleMesh out = isosurface(grid.field());
  if (stop_requested()) return stopped_error();
  MeshLimits limits;
  limits.max_triangles = o.max_triangles;
  if (Status s = validate(out, limits); !s) return s.error();
  return out;
}

/// The first surface, `stand` off the mesh.
Result<TriangleMesh> first_surface(const Hierarchy& surface, const WrapOptions& o, double radius,
                                   double stand) {
  auto grid = OutsideGrid::make(surface.bounds(), radius, o.cell, o.max_bytes);
  if (!grid) return grid.error();
  grid->measure(surface, radius, o.crew);
  grid->fill_unreached();
  if (stop_requested()) return stopped_error();
  tell_progress(0.2);
  if (radius > stand) grid->grow_outside(radius - stand, o.crew);
  if (stop_requested()) return stopped_error();
  grid->keep_off_nodes(tolerances::off_nodes * o.cell);
  return surface_of(*grid, o);
}

/// The point of one mesh that is farthest from another: the triangles of the first are divided
/// while their points may be farther away than what was found, by more than a share of it. No point
/// of a triangle is farther from a triangle of the other than one of its corners is, as that is
/// convex.
///
/// All triangles are looked at once before any is divided, so that nearly all need not be; each is
/// then divided to the end, so that no more than the parts of one are kept.
class FarthestPoint {
 public:
  FarthestPoint(const TriangleMesh& from, const Hierarchy& to) : to_(to) {
    for (const Vec3& p : from.vertices) found_ = std::max(found_, distance_from(to, p));
    std::vector<double> most;
    for (size_t t = 0; t < from.triangles.size() && !stop_requested(); ++t)
      most.push_back(look_at(corners(from, uint32_t(t))));
    for (size_t t = 0; t < most.size() && !stop_requested(); ++t)
      if (most[t] > bound()) divide(corners(from, uint32_t(t)));
  }
  double found() const { return found_; }
  double bound() const { return found_ * (1 + tolerances::measured_share); }

 private:
  /// Finds the distance of its middle; returns one that no point of it exceeds.
  double look_at(const TriangleCorners& t) {
    const Vec3 middle = (t[0] + t[1] + t[2]) / 3;
    const auto near = to_.closest(middle, std::numeric_limits<double>::infinity());
    if (!near) return 0;
    found_ = std::max(found_, std::sqrt(near->squared_distance));
    const TriangleCorners other = corners(to_.mesh(), near->triangle);
    double most = 0;
    for (const Vec3& p : t)
      most = std::max(most, closest_on_triangle(p, other[0], other[1], other[2]).squared_distance);
    return std::sqrt(most);
  }

  void divide(const TriangleCorners& whole) {
    std::vector<TriangleCorners> open{whole};
    while (!open.empty() && !stop_requested()) {
      TriangleCorners a = open.back();
      open.pop_back();
      if (look_at(a) <= bound()) continue;
      // In half across the longest side.
      size_t k = 0;
      for (size_t i = 1; i < 3; ++i)
        if ((a[(i + 1) % 3] - a[i]).squaredNorm() > (a[(k + 1) % 3] - a[k]).squaredNorm()) k = i;
      TriangleCorners b = a;
      a[(k + 1) % 3] = b[k] = 0.5 * (a[k] + a[(k + 1) % 3]);
      open.push_back(a);
      open.push_back(b);
    }
  }

  const Hierarchy& to_;
  double found_ = 0;
};

}  // namespace

WrapOptions complete(WrapOptions o, const Aabb& bounds) {
  const double size = bounds.extent().maxCoeff();
  if (o.gap == 0) o.gap = size / 12;
  if (o.cell == 0) o.cell = std::clamp(o.gap / 4, size / 128, size / 40);
  if (o.offset == 0) o.offset = o.cell / 4;
  if (o.tolerance == 0) o.tolerance = o.cell / 4;
  return o;
}

Result<WrappedMesh> wrap_mesh(const Hierarchy& surface, const WrapOptions& options) {
  if (Status s = check_wrap(surface.mesh(), options); !s) return s.error();
  const Aabb box = surface.bounds();
  const double size = box.extent().maxCoeff();
  if (!(size > 0)) return bad_wrap("a mesh without extent cannot be wrapped");
  const WrapOptions o = complete(options, box);
  if (o.offset < tolerances::least_offset * size)
    return bad_wrap(
        fmt::format("a wrap cannot stand {:.3g} m off a mesh of {:.3g} m", o.offset, size),
        fmt::format("an offset of {:.3g} m would do", tolerances::least_offset * size));
  double stand = o.offset + tolerances::first_stand * o.cell;
  const double radius = std::max(o.gap / 2, stand);
  if (radius - stand < tolerances::least_way_back * o.cell) stand = radius;
  tell_progress(0);
  auto made = first_surface(surface, o, radius, stand);
  if (!made) return made.error();
  WrappedMesh out;
  out.mesh = *std::move(made);
  tell_progress(0.3);
  const EnclosedMesh enclosed(surface, tolerances::least_clearance * o.offset);
  if (stop_requested()) return stopped_error();
  even_out_wrap(out.mesh, enclosed,
                {tolerances::even_error * o.cell, o.cell, tolerances::even_edge * o.cell});
  if (stop_requested()) return stopped_error();
  tell_progress(0.4);
  fit_wrap(out.mesh, enclosed, {o.offset, stand, o.cell, o.crew});
  if (stop_requested()) return stopped_error();
  tell_progress(0.6);
  simplify_wrap(out.mesh, enclosed, {o.tolerance, o.cell});
  if (stop_requested()) return stopped_error();
  tell_progress(0.9);
  out.report = measure_wrap(AabbTree(std::make_shared<const TriangleMesh>(out.mesh)), surface);
  if (stop_requested()) return stopped_error();
  tell_progress(1);
  out.report.gap = 2 * radius;
  out.report.offset = o.offset;
  out.report.cell = o.cell;
  return out;
}

WrapReport measure_wrap(const Hierarchy& wrap, const Hierarchy& mesh) {
  WrapReport out;
  const FarthestPoint farthest(wrap.mesh(), mesh);
  out.added = farthest.found();
  out.bound = farthest.bound();
  if (const auto near = wrap.distance(mesh, Pose{}, std::numeric_limits<double>::infinity()))
    out.nearest = std::sqrt(near->squared_distance);
  each_measured_point(mesh.mesh(), [&](const Vec3& p) {
    const double d = distance_from(wrap, p);
    if (d <= std::min(out.missing, out.buried)) return;
    double& side = point_in_object(p, wrap).side == PointSide::outside ? out.missing : out.buried;
    side = std::max(side, d);
  });
  return out;
}

}  // namespace tumble
