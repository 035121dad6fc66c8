#include "engine/collision/fitting/fit_primitive.hpp"

#include "engine/collision/fitting/least_squares_fit.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/watched.hpp"
#include "engine/geometry/constructions/surface_samples.hpp"
#include "engine/geometry/hierarchy/fit_box.hpp"
#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/geometry/mass_properties/principal_axes.hpp"
#include "engine/geometry/mesh_topology.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr size_t fitted_points = 400;      ///< that a surface is to run through
constexpr size_t rough_samples = 200;      ///< to compare fits of one kind
constexpr size_t measured_samples = 2000;  ///< of the error that is told
constexpr size_t best_starts = 3;          ///< of a kind that are followed to the end
constexpr double alike = 0.99;             ///< a later kind must err by less than this share

std::vector<Vec3> points_of(const TriangleMesh& mesh) {
  const SurfaceSamples on_surface(mesh);
  std::vector<Vec3> out;
  for (size_t n = 1; n <= fitted_points; ++n) out.push_back(on_surface(n).point);
  return out;
}

Float4 float4_of(const Vec3& p) {
  return Float4::round(p.x(), p.y(), p.z());
}

Mat3 spread_axes(const std::vector<Vec3>& points) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points) mean += p / double(points.size());
  Mat3 spread = Mat3::Zero();
  for (const Vec3& p : points) spread += (p - mean) * (p - mean).transpose();
  return principal_axes(spread).axes;
}

Mat3 box_axes(const std::vector<Vec3>& corners, const Vec3& middle) {
  ExtremePoints extreme(float4_of(corners[0] - middle));
  for (const Vec3& p : corners) extreme.include(float4_of(p - middle));
  const Rows3 rows = tight_axes(extreme);
  Mat3 out;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) out(c, r) = double(rows.row[size_t(r)].array()[size_t(c)]);
  // Single precision: made orthonormal in double (Gram and Schmidt).
  out.col(0).normalize();
  out.col(1) = (out.col(1) - out.col(0).dot(out.col(1)) * out.col(0)).normalized();
  out.col(2) = out.col(0).cross(out.col(1));
  return out;
}

/// The frame whose y is an axis.
Mat3 frame_about(const Vec3& y) {
  int thin = 0;
  y.cwiseAbs().minCoeff(&thin);
  const Vec3 x = Vec3(Vec3::Unit(thin)).cross(y).normalized();
  return Mat3::from_columns(x, y, x.cross(y));
}

/// Where fits begin: frames, and their axes without those that nearly repeat one.
struct Beginnings {
  std::vector<Mat3> frames;
  std::vector<Vec3> axes;

  Beginnings(const std::vector<Vec3>& points, const std::vector<Vec3>& corners,
             const Vec3& middle) {
    frames = {Mat3::Identity(), spread_axes(points), box_axes(corners, middle)};
    constexpr double same = 0.999;  // 2.6 degrees
    for (const Mat3& frame : frames)
      for (int k = 0; k < 3; ++k) {
        const Vec3 axis = frame.col(k);
        const auto repeats = [&](const Vec3& a) { return std::fabs(a.dot(axis)) > same; };
        if (std::none_of(axes.begin(), axes.end(), repeats)) axes.push_back(axis);
      }
  }
};

PrimitiveGuess beginning(const PrimitiveKind& kind, const Mat3& frame,
                         std::span<const Vec3> points) {
  Aabb box;
  std::vector<Vec3> own(points.begin(), points.end());
  for (Vec3& p : own) box.include(p = frame.transpose() * p);
  for (Vec3& p : own) p -= box.centre();
  PrimitiveGuess out;
  out.pose = {frame * box.centre(), Quat(frame).normalized()};
  out.size = kind.begin(own, 0.5 * box.extent());
  return out;
}

/// Fits of one kind through one set of points, from the most promising beginnings.
std::vector<PrimitiveGuess> fits_of(const PrimitiveKind& kind, const Beginnings& from,
                                    const std::vector<Vec3>& points, double scale) {
  std::vector<std::pair<double, PrimitiveGuess>> guesses;
  const auto begin_at = [&](const Mat3& frame) {
    const PrimitiveGuess guess = beginning(kind, frame, points);
    guesses.emplace_back(surface_misfit(kind, guess, points), guess);
  };
  if (kind.round) {
    for (const Vec3& axis : from.axes) {
      begin_at(frame_about(axis));
      if (kind.upright) begin_at(frame_about(-axis));
    }
  } else {
    for (const Mat3& frame : from.frames) begin_at(frame);
  }
  std::stable_sort(guesses.begin(), guesses.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<PrimitiveGuess> out;
  for (size_t k = 0; k < std::min(best_starts, guesses.size()); ++k)
    out.push_back(fit_least_squares(kind, guesses[k].second, points, scale));
  return out;
}

}  // namespace

Result<std::vector<FittedPrimitive>> fit_primitives(const Hierarchy& surface) {
  const TriangleMesh& mesh = surface.mesh();
  const auto refuse = [](const char* why) {
    return Error{ErrorCode::invalid_argument,
                 std::string("no primitive fits the mesh: ") + why,
                 {},
                 "take its triangles"};
  };
  if (mesh.triangles.empty()) return refuse("it has no triangles");
  const auto hull = convex_hull(mesh.vertices);
  if (!hull) return refuse("all of it lies in one plane");
  const TriangleMesh hull_mesh = to_mesh(hull->polyhedron);
  const std::vector<Vec3> through_mesh = points_of(mesh), through_hull = points_of(hull_mesh);
  const Aabb box = surface.bounds();
  const double scale = 0.5 * box.extent().norm();
  const bool closed = build_topology(mesh).closed_and_oriented();
  const auto mass = mesh_mass(mesh);
  const Beginnings from(through_hull, hull_mesh.vertices, box.centre());

  std::vector<FittedPrimitive> out;
  for (size_t k = 0; k < primitive_kinds().size(); ++k) {
    const PrimitiveKind& kind = primitive_kinds()[k];
    tell_progress(double(k) / double(primitive_kinds().size()));
    FittedPrimitive best;
    std::vector<PlacedShape> best_shape;
    for (const auto* points : {&through_mesh, &through_hull})
      for (const PrimitiveGuess& guess : fits_of(kind, from, *points, scale)) {
        if (stop_requested()) return stopped_error();
        const ShapeDef def = kind.shape(guess.size);
        auto shape = make_shape(def);
        if (!shape) continue;
        const std::vector<PlacedShape> placed{{*shape, guess.pose}};
        const SolidError error = solid_error(placed, surface, closed, rough_samples);
        if (!best_shape.empty() && !(error.larger() < alike * best.error.larger())) continue;
        best.shape = def;
        best.pose = guess.pose;
        best.error = error;
        best_shape = placed;
      }
    if (best_shape.empty()) continue;
    best.error = solid_error(best_shape, surface, closed, measured_samples);
    if (const auto own = best_shape[0].shape->mass_properties()) best.volume = own->mass;
    best.mesh_volume = mass ? mass->mass : 0;
    out.push_back(std::move(best));
  }
  if (stop_requested()) return stopped_error();
  if (out.empty()) return refuse("it is too flat");
  size_t first = 0;
  for (size_t k = 1; k < out.size(); ++k)
    if (out[k].error.larger() < alike * out[first].error.larger()) first = k;
  std::rotate(out.begin(), out.begin() + std::ptrdiff_t(first),
              out.begin() + std::ptrdiff_t(first) + 1);
  std::stable_sort(out.begin() + 1, out.end(), [](const auto& a, const auto& b) {
    return a.error.larger() < b.error.larger();
  });
  // What reaches farther outside than the mesh is large stands for something else.
  std::erase_if(out, [&, best = out.front().error.added](const FittedPrimitive& fit) {
    return fit.error.added > std::max(best, 2 * scale);
  });
  return out;
}

Result<FittedPrimitive> fit_primitive(const Hierarchy& surface) {
  auto all = fit_primitives(surface);
  if (!all) return all.error();
  return std::move(all->front());
}

}  // namespace tumble
