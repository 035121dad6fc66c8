#include "engine/core/stop.hpp"
#include "engine/geometry/decomposition/convex_decomposition.hpp"
#include "engine/geometry/decomposition/cut_planes.hpp"
#include "engine/geometry/decomposition/plane_cut.hpp"
#include "engine/geometry/decomposition/tolerances.hpp"
#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/solid/solid_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

class ExactDecomposer {
 public:
  ExactDecomposer(const TriangleMesh& mesh, const ExactDecompositionOptions& options)
      : mesh_(mesh), options_(options) {}

  Result<ConvexDecomposition> run() {
    if (!(options_.tolerance >= 0) || !std::isfinite(options_.tolerance) || options_.max_pieces < 1)
      return Error{
          ErrorCode::invalid_argument,
          fmt::format(
              "a decomposition needs a tolerance >= 0 m and at least one piece, got {} m and {}",
              options_.tolerance, options_.max_pieces),
          {},
          {}};
    if (Status s = check_solid(mesh_).status(); !s) return s.error();
    const Aabb box = bounds(mesh_);
    const double far = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
    tolerance_ = std::max({options_.tolerance, tolerances::on_plane * box.extent().norm(),
                           tolerances::on_plane_far * far});
    least_tolerance_ = tolerances::on_plane_least * (box.extent().norm() + far);
    start();
    while (!waiting_.empty()) {
      if (stop_requested()) return stopped_error();
      if (options_.progress) options_.progress(out_.pieces.size(), waiting_.size());
      SolidPiece piece = std::move(waiting_.back());
      waiting_.pop_back();
      if (Status s = advance(std::move(piece)); !s) return s.error();
      if (out_.pieces.size() + waiting_.size() > options_.max_pieces)
        return Error{
            ErrorCode::unsupported,
            fmt::format("an exact decomposition takes more than {} pieces", options_.max_pieces),
            {},
            "allow a larger tolerance or more pieces, or decompose approximately"};
    }
    return std::move(out_);
  }

 private:
  void start() {
    const std::vector<TriangleSide> mates = side_mates(mesh_);
    FlatFaces faces = find_faces(mesh_, mates, tolerance_);
    planes_ = std::move(faces.planes);
    out_.exact = true;
    out_.mesh_volume = enclosed_volume(mesh_);
    double lost = 0;
    waiting_ = separate_solids(mesh_, faces.of_triangle, mates, tolerance_, lost);
  }

  /// Cuts a solid once, or keeps it as a piece when it has no notch.
  Status advance(SolidPiece piece) {
    const std::vector<Notch> notches = find_notches(piece, planes_, tolerance_);
    if (notches.empty()) return keep(piece);
    const std::vector<Plane> planes = cut_planes(piece, notches, planes_, cut_tolerance());
    // Where faces are nearly parallel to a cut, corners near to it are far from where it meets the
    // faces: then only those of the reflex edge itself count as on it.
    const bool cut = cut_by_one(piece, notches, planes, cut_tolerance(), cut_tolerance()) ||
                     cut_by_one(piece, notches, planes, 0, least_tolerance_);
    if (cut) return {};
    if (stop_requested()) return stopped_error();
    const Vec3 where = piece.mesh.vertices[notches[0].vertices[0]];
    return Error{ErrorCode::numeric,
                 fmt::format("no plane cuts the reflex edge at ({:.6g}, {:.6g}, {:.6g}) cleanly",
                             where.x(), where.y(), where.z()),
                 {},
                 "try another tolerance, or decompose approximately"};
  }

  /// Cuts by the first plane that will do; false when none does. Corners within `tolerance` are on
  /// the plane, and so are edges within `edge_tolerance`.
  bool cut_by_one(const SolidPiece& piece, std::span<const Notch> notches,
                  std::span<const Plane> planes, double tolerance, double edge_tolerance) {
    CutRequest request;
    request.plane_number = uint32_t(planes_.size());
    request.tolerance = tolerance;
    for (const Plane& plane : planes) {
      if (stop_requested()) return false;
      request.plane = plane;
      request.edges = notches_on(plane, piece, notches, edge_tolerance);
      if (request.edges.empty()) continue;
      auto cut = cut_solid(piece, request);
      if (!cut || !gets_on(*cut, plane, notches.size())) continue;
      add_planes(plane);
      ++out_.cuts;
      for (SolidPiece& p : cut->pieces) waiting_.push_back(std::move(p));
      return true;
    }
    return false;
  }

  /// Corners of a face are within the tolerance of its plane: planes through two of them meet the
  /// others within some of it.
  double cut_tolerance() const { return 4 * tolerance_; }

  /// A cut that divides nothing and takes no notch away would go on for ever.
  bool gets_on(const CutResult& cut, const Plane& plane, size_t notches) {
    if (cut.pieces.size() != 1) return cut.pieces.size() > 1;
    add_planes(plane);
    const size_t left = find_notches(cut.pieces[0], planes_, tolerance_).size();
    planes_.resize(planes_.size() - 2);
    return left < notches;
  }

  /// Of the faces of a cut: beneath it, and over it.
  void add_planes(const Plane& plane) {
    planes_.push_back(plane);
    planes_.push_back({-plane.normal, -plane.offset});
  }

  Status keep(const SolidPiece& piece) {
    const double relative = tolerance_ / bounds(piece.mesh).extent().norm();
    auto hull = convex_hull(piece.mesh.vertices, {std::min(relative, 0.01)});
    const double solid = enclosed_volume(piece.mesh);
    if (!hull) {
      // As flat as the tolerance.
      if (solid <= tolerance_ * surface_area(piece.mesh)) return {};
      return hull.error();
    }
    ConvexPiece& out = out_.pieces.emplace_back();
    out.volume = polyhedron_mass(hull->polyhedron).mass;
    out.hull = std::move(hull->polyhedron);
    out.solid = solid;
    out_.hull_volume += out.volume;
    out_.solid_volume += solid;
    return {};
  }

  const TriangleMesh& mesh_;
  const ExactDecompositionOptions& options_;
  double tolerance_ = 0, least_tolerance_ = 0;
  std::vector<Plane> planes_;
  std::vector<SolidPiece> waiting_;
  ConvexDecomposition out_;
};

}  // namespace

Result<ConvexDecomposition> decompose_exactly(const TriangleMesh& mesh,
                                              const ExactDecompositionOptions& options) {
  return ExactDecomposer(mesh, options).run();
}

}  // namespace tumble
