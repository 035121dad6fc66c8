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
    rounding_ = tolerances::rounding * (box.extent().norm() + far);
    if (Status s = start(); !s) return s.error();
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
    out_.left_out = left_out_.count;
    out_.left_out_volume = left_out_.volume;
    return std::move(out_);
  }

 private:
  Status start() {
    out_.exact = true;
    out_.mesh_volume = enclosed_volume(mesh_);
    space_ = ExactSpace(mesh_.vertices);
    auto solids = make_solids(mesh_, space_, rounding_);
    if (!solids) return solids.error();
    waiting_ = std::move(solids->pieces);
    edges_ = std::move(solids->edges);
    left_out_ = solids->left_out;
    return {};
  }

  /// Cuts a solid once, or keeps it as a piece if it is convex.
  Status advance(SolidPiece piece) {
    std::vector<Notch> notches = find_notches(space_, piece, tolerance_);
    if (notches.empty()) {
      // Faces narrower than the tolerance may hide a notch between them.
      notches = find_notches(space_, piece, 0);
      if (keep(piece, notches.empty())) return {};
    }
    const std::vector<CutPlane> planes = cut_planes(space_, piece, notches, edges_, 4 * tolerance_);
    if (planes.empty()) return unsound();
    CutRequest request;
    const auto& [a, b, c] = planes[0].through;
    request.plane = space_.add_plane(a, b, c);
    request.touching = 4 * tolerance_;
    request.skin = rounding_;
    request.left_out = &left_out_;
    auto cut = cut_solid(space_, std::move(piece), request);
    if (!cut) return unsound();
    ++out_.cuts;
    for (SolidPiece& p : *cut) waiting_.push_back(std::move(p));
    return {};
  }
  static Status unsound() {
    return Error{ErrorCode::numeric,
                 "a part of the mesh is not the surface of a solid",
                 {},
                 "mend the mesh (`tumble mesh` says where), or decompose approximately"};
  }

  /// Adds a solid's hull as a piece if the solid fills it. A solid without a hull or volume is
  /// within rounding of flat, and is left out.
  bool keep(const SolidPiece& piece, bool convex) {
    const TriangleMesh mesh = to_mesh(space_, piece);
    const double extent = bounds(mesh).extent().norm(), solid = enclosed_volume(mesh);
    if (solid <= tolerances::no_volume * out_.mesh_volume) return leave_out(solid);
    const double thin = std::max(options_.tolerance, rounding_);
    auto hull = convex_hull(mesh.vertices, {std::min(thin / extent, 0.01)});
    if (!hull) hull = convex_hull(mesh.vertices, {std::min(rounding_ / extent, 0.01)});
    if (!hull) return leave_out(solid);
    const double volume = polyhedron_mass(hull->polyhedron).mass;
    if (!convex && volume - solid > thin * surface_area(mesh)) return false;
    ConvexPiece& out = out_.pieces.emplace_back();
    out.volume = volume;
    out.hull = std::move(hull->polyhedron);
    out.solid = solid;
    out_.hull_volume += out.volume;
    out_.solid_volume += solid;
    return true;
  }

  bool leave_out(double volume) {
    left_out_.add(volume);
    return true;
  }

  const TriangleMesh& mesh_;
  const ExactDecompositionOptions& options_;
  ExactSpace space_;
  double tolerance_ = 0, rounding_ = 0;
  std::vector<ReflexEdge> edges_;
  std::vector<SolidPiece> waiting_;
  LeftOut left_out_;
  ConvexDecomposition out_;
};

}  // namespace

Result<ConvexDecomposition> decompose_exactly(const TriangleMesh& mesh,
                                              const ExactDecompositionOptions& options) {
  return ExactDecomposer(mesh, options).run();
}

}  // namespace tumble
