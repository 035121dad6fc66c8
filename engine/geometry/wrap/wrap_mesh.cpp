#include "engine/geometry/wrap/wrap_mesh.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/watched.hpp"
#include "engine/geometry/constructions/surface_samples.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/isosurface/marching_tetrahedra.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"
#include "engine/geometry/wrap/outside_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Twice the circumradius of a tetrahedron, with a margin for rounding [cells].
constexpr double least_offset = 1.75;
constexpr size_t measured_points = 4000;

Error bad_wrap(std::string message, std::string cure = {}) {
  return {ErrorCode::invalid_argument, std::move(message), {}, std::move(cure)};
}

Status check_wrap(const TriangleMesh& mesh, const WrapOptions& o) {
  if (Status s = validate(mesh); !s) return s.error();
  for (const auto& [name, value] :
       {std::pair{"gap", o.gap}, {"offset", o.offset}, {"cell", o.cell}})
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
  // A closed surface has about two triangles per vertex (Euler).
  const double triangles = 2 * double(grid.cut_edges());
  if (stop_requested()) return stopped_error();
  if (triangles > double(o.max_triangles))
    return bad_wrap(
        fmt::format("a wrap with cells of {:.3g} m would have {:.3g} triangles, at most {} are "
                    "allowed",
                    o.cell, triangles, o.max_triangles),
        fmt::format("cells of {:.2g} m would do",
                    1.1 * o.cell * std::sqrt(triangles / double(o.max_triangles))));
  TriangleMesh out = isosurface(grid.field());
  if (stop_requested()) return stopped_error();
  MeshLimits limits;
  limits.max_triangles = o.max_triangles;
  if (Status s = validate(out, limits); !s) return s.error();
  return out;
}

}  // namespace

WrapOptions complete(WrapOptions o, const Aabb& bounds) {
  const double size = bounds.extent().maxCoeff();
  if (o.gap == 0) o.gap = size / 12;
  if (o.cell == 0)
    o.cell = o.offset > 0 ? o.offset / 2 : std::clamp(o.gap / 4, size / 128, size / 40);
  if (o.offset == 0) o.offset = 2 * o.cell;
  return o;
}

Result<WrappedMesh> wrap_mesh(const Hierarchy& surface, const WrapOptions& options) {
  if (Status s = check_wrap(surface.mesh(), options); !s) return s.error();
  const Aabb box = surface.bounds();
  if (!(box.extent().maxCoeff() > 0)) return bad_wrap("a mesh without extent cannot be wrapped");
  const WrapOptions o = complete(options, box);
  if (o.offset < least_offset * o.cell)
    return bad_wrap(fmt::format("a wrap {:.3g} m off its mesh needs smaller cells than {:.3g} m",
                                o.offset, o.cell),
                    fmt::format("cells of {:.3g} m, or an offset of {:.3g} m, would do",
                                o.offset / least_offset, least_offset * o.cell));
  const double radius = std::max(o.gap / 2, o.offset), back = radius - o.offset;
  auto grid = OutsideGrid::make(box, radius, o.cell, o.max_bytes);
  if (!grid) return grid.error();
  tell_progress(0);
  grid->measure(
      surface, [&](double d, bool) { return d - radius; }, o.crew);
  grid->fill_unreached();
  tell_progress(0.3);
  auto made = surface_of(*grid, o);
  if (made && back > 0) {
    const AabbTree reached(std::make_shared<const TriangleMesh>(*std::move(made)));
    tell_progress(0.4);
    grid->measure(
        reached, [&](double d, bool inside) { return back - (inside ? d : -d); }, o.crew);
    grid->fill_unreached();
    tell_progress(0.7);
    made = surface_of(*grid, o);
  }
  if (!made) return made.error();
  WrappedMesh out;
  out.mesh = *std::move(made);
  out.report = measure_wrap(AabbTree(std::make_shared<const TriangleMesh>(out.mesh)), surface);
  tell_progress(1);
  out.report.gap = 2 * radius;
  out.report.offset = o.offset;
  out.report.cell = o.cell;
  // The boundary of the outside is at most `radius` from the mesh, and the wrap at most `back` from
  // that.
  out.report.bound = radius + back + least_offset / 2 * o.cell * (back > 0 ? 2 : 1);
  if (stop_requested()) return stopped_error();
  return out;
}

WrapReport measure_wrap(const Hierarchy& wrap, const Hierarchy& mesh) {
  WrapReport out;
  each_measured_point(
      wrap.mesh(), [&](const Vec3& p) { out.added = std::max(out.added, distance_from(mesh, p)); });
  each_measured_point(mesh.mesh(), [&](const Vec3& p) {
    const double d = distance_from(wrap, p);
    if (d <= std::min(out.missing, out.buried)) return;
    double& side = point_in_object(p, wrap).side == PointSide::outside ? out.missing : out.buried;
    side = std::max(side, d);
  });
  return out;
}

}  // namespace tumble
