#include "engine/core/crew.hpp"
#include "engine/core/stop.hpp"
#include "engine/geometry/decomposition/convex_decomposition.hpp"
#include "engine/geometry/decomposition/cut_planes.hpp"
#include "engine/geometry/decomposition/hull_error.hpp"
#include "engine/geometry/decomposition/plane_cut.hpp"
#include "engine/geometry/decomposition/tolerances.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/geometry/hull/quickhull.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/solid/solid_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr size_t deciding_samples = 250;     ///< per hull, while pieces are cut and merged
constexpr size_t reporting_samples = 4000;   ///< in total, for the report
constexpr int slices = 9;                    ///< cuts tried along each axis
constexpr size_t notch_planes = 12;          ///< cutting planes tried through reflex edges
constexpr size_t most_scored_points = 2000;  ///< points of a piece used to compare single cuts
constexpr size_t most_paired_points = 400;   ///< points of a piece used to compare pairs of cuts
constexpr size_t most_notches = 1500;        ///< reflex edges of a piece that are considered
constexpr double anywhere = std::numeric_limits<double>::infinity();

/// Volume of the convex hull of points; 0 when they are flat.
double hull_volume(std::span<const Vec3> points, double tolerance) {
  if (points.size() < 4) return 0;
  const auto triangles = quickhull(points, tolerance);
  if (!triangles) return 0;
  const Vec3& about = points[(*triangles)[0].vertices[0]];
  double six = 0;
  for (const HullTriangle& t : *triangles)
    six += (points[t.vertices[0]] - about)
               .dot((points[t.vertices[1]] - about).cross(points[t.vertices[2]] - about));
  return six / 6;
}

/// A part of the solid and its hull.
struct Part {
  SolidPiece solid;  ///< empty once parts have been merged
  ConvexPiece piece;
  TriangleMesh surface;     ///< surface of the hull
  TriangleMesh stands_for;  ///< surfaces of the solids whose hull it is
  Aabb box;
};

/// A merger of two parts.
struct Merger {
  size_t a = 0, b = 0;
  Part result;
  double grown = 0;  ///< volume added to that of the two parts [m^3]
  enum class Reach { unknown, too_far, known };
  Reach reach = Reach::unknown;   ///< of result.piece.added
  Reach hollow = Reach::unknown;  ///< how far the hull reaches outside the solids that it replaces
};

class ApproximateDecomposer {
 public:
  ApproximateDecomposer(const Hierarchy& surface, const ApproximateDecompositionOptions& options)
      : surface_(surface), mesh_(surface.mesh()), options_(options) {}

  Result<ConvexDecomposition> run() {
    if (!(options_.concavity >= 0) || !std::isfinite(options_.concavity) || options_.max_pieces < 1)
      return Error{
          ErrorCode::invalid_argument,
          fmt::format(
              "a decomposition needs a concavity >= 0 m and at least one piece, got {} m and {}",
              options_.concavity, options_.max_pieces),
          {},
          {}};
    if (Status s = check_solid(mesh_).status(); !s) return s.error();
    const double diagonal = surface_.bounds().extent().norm();
    const double far =
        surface_.bounds().min.cwiseAbs().cwiseMax(surface_.bounds().max.cwiseAbs()).maxCoeff();
    tolerance_ = std::max(tolerances::on_plane_roughly * diagonal, tolerances::on_plane_far * far);
    bound_ = options_.concavity > 0 ? options_.concavity : diagonal / 50;
    Status done = start();
    if (done) done = cut_all();
    if (done) done = merge_all();
    if (stop_requested()) return stopped_error();
    if (!done) return done.error();
    Result<ConvexDecomposition> out = finish();
    if (stop_requested()) return stopped_error();
    return out;
  }

 private:
  /// The solids of the mesh. Those with few reflex edges are replaced by their exact convex pieces,
  /// which then only have to be merged.
  Status start() {
    space_ = ExactSpace(mesh_.vertices);
    auto made = make_solids(mesh_, space_, tolerance_);
    if (!made) return made.error();
    std::vector<SolidPiece>& solids = made->pieces;
    edges_ = std::move(made->edges);
    size_t notches = 0;
    for (const SolidPiece& s : solids) notches += find_notches(space_, s, tolerance_).size();
    if (notches <= most_notches && start_with_exact_pieces()) return {};
    for (SolidPiece& s : solids) {
      if (stop_requested()) return stopped_error();
      if (auto part = make_part(std::move(s))) parts_.push_back(*std::move(part));
    }
    if (parts_.empty())
      return Error{
          ErrorCode::invalid_argument, "the mesh is too thin to be cut into solids", {}, {}};
    return {};
  }

  size_t most_parts() const { return 4 * options_.max_pieces + 32; }

  bool start_with_exact_pieces() {
    ExactDecompositionOptions exact;
    exact.tolerance = std::max(tolerance_, bound_ / 1000);
    exact.max_pieces = most_parts();
    exact.progress = options_.progress;
    auto pieces = decompose_exactly(mesh_, exact);
    if (!pieces) return false;
    cuts_ = pieces->cuts;
    for (ConvexPiece& piece : pieces->pieces) {
      if (stop_requested()) return false;
      Part& part = parts_.emplace_back();
      part.piece = std::move(piece);
      measure(part);
      part.stands_for = part.surface;
      part.piece.added = reach(part, bound_);
    }
    // If the tolerance is too large for thin parts, volume is lost.
    const bool whole = std::fabs(pieces->solid_volume - pieces->mesh_volume) <=
                           tolerances::lost_volume * pieces->mesh_volume &&
                       std::all_of(parts_.begin(), parts_.end(),
                                   [&](const Part& p) { return p.piece.added <= bound_; });
    if (!whole) parts_.clear();
    return whole;
  }

  /// Empty if the solid is flat within the tolerance.
  std::optional<Part> make_part(SolidPiece solid) const {
    TriangleMesh mesh = to_mesh(space_, solid);
    auto hull = convex_hull(mesh.vertices);
    if (!hull) return std::nullopt;
    Part out;
    out.piece.hull = std::move(hull->polyhedron);
    out.piece.solid = enclosed_volume(mesh);
    measure(out);
    out.piece.added = reach(out, bound_);
    out.stands_for = std::move(mesh);
    out.solid = std::move(solid);
    return out;
  }
  void measure(Part& part) const {
    part.piece.volume = polyhedron_mass(part.piece.hull).mass;
    part.surface = to_mesh(part.piece.hull);
    part.box = bounds(part.surface);
  }
  /// The distance that a part's hull reaches outside the mesh; the computation stops once it is
  /// known to exceed `enough`.
  double reach(const Part& part, double enough) const {
    return reach_outside(part.surface, surface_, deciding_samples, enough);
  }

  /// Cuts the part with the worst hull until all are within the bound, or there are far more parts
  /// than allowed.
  Status cut_all() {
    while (parts_.size() < most_parts()) {
      if (stop_requested()) return stopped_error();
      const auto hollow = [&](const Part& p) {
        return p.piece.added > bound_ ? p.piece.volume - p.piece.solid : -anywhere;
      };
      const auto worst =
          std::max_element(parts_.begin(), parts_.end(),
                           [&](const Part& a, const Part& b) { return hollow(a) < hollow(b); });
      if (worst->piece.added <= bound_) return {};
      if (options_.progress)
        options_.progress(
            size_t(std::count_if(parts_.begin(), parts_.end(),
                                 [&](const Part& p) { return p.piece.added <= bound_; })),
            parts_.size());
      if (!cut(size_t(worst - parts_.begin())))
        return Error{
            ErrorCode::numeric, "a part could not be cut cleanly", {}, "try another concavity"};
    }
    return {};
  }

  bool cut(size_t number) {
    for (const CutPlane& plane : ranked(parts_[number].stands_for, candidate_planes(number))) {
      if (stop_requested()) return false;
      CutRequest request;
      const auto& [a, b, c] = plane.through;
      request.plane = space_.add_plane(a, b, c);
      request.skin = tolerance_;
      auto result = cut_solid(space_, parts_[number].solid, request);
      if (!result || result->size() < 2) continue;
      std::vector<Part> fresh;
      for (SolidPiece& s : *result)
        if (auto part = make_part(std::move(s))) fresh.push_back(*std::move(part));
      if (fresh.size() < 2) continue;
      parts_[number] = std::move(fresh[0]);
      for (size_t n = 1; n < fresh.size(); ++n) parts_.push_back(std::move(fresh[n]));
      ++cuts_;
      return true;
    }
    return false;
  }

  /// Slices perpendicular to the axes of the mesh's frame, and planes through reflex edges.
  std::vector<CutPlane> candidate_planes(size_t number) const {
    const SolidPiece& solid = parts_[number].solid;
    std::vector<CutPlane> out;
    const Aabb box = bounds(parts_[number].stands_for);
    for (int k = 0; k < 3; ++k)
      for (int n = 1; n <= slices; ++n) {
        const Plane plane{Vec3::Unit(k), box.min[k] + box.extent()[k] * n / (slices + 1)};
        Vec3 a = box.min, b, c;
        a[k] = plane.offset;
        b = a + box.extent().norm() * Vec3::Unit((k + 1) % 3);
        c = a + box.extent().norm() * Vec3::Unit((k + 2) % 3);
        out.push_back({plane, {a, b, c}});
      }
    const std::vector<Notch> notches = find_notches(space_, solid, bound_ / 8);
    if (notches.empty() || notches.size() > most_notches) return out;
    const std::vector<CutPlane> through = cut_planes(space_, solid, notches, edges_, tolerance_);
    size_t taken = 0;
    for (size_t i = 0; i < through.size() && taken < notch_planes; ++i) {
      const bool again = std::any_of(out.begin(), out.end(), [&](const CutPlane& p) {
        return same_plane(p.near, through[i].near, box);
      });
      if (again) continue;
      out.push_back(through[i]);
      ++taken;
    }
    return out;
  }
  static bool same_plane(const Plane& a, const Plane& b, const Aabb& box) {
    return a.normal.cross(b.normal).norm() < tolerances::same_cut_direction &&
           std::fabs(a.distance(box.centre()) -
                     (a.normal.dot(b.normal) > 0 ? 1 : -1) * b.distance(box.centre())) <
               tolerances::same_cut_direction * box.extent().norm();
  }

  /// The planes sorted by the total volume of the hulls on both sides, or by that per cut together
  /// with a second slice across, if it is less: no single cut reduces the hull of a ring, and
  /// slices along its axis never do, but two through the axis leave four arcs.
  std::vector<CutPlane> ranked(const TriangleMesh& mesh, std::vector<CutPlane> planes) const {
    std::vector<double> volume(planes.size());
    const double whole = hull_volume(mesh.vertices, tolerance_);
    const std::vector<double> paired = pair_volumes(mesh, planes);
    const auto score = [&](size_t i) {
      if (stop_requested()) return;
      volume[i] = split_volume(mesh, planes[i].near);
      // Three cuts leave four parts.
      if (i < paired.size()) volume[i] = std::min(volume[i], whole - (whole - paired[i]) / 3);
    };
    if (options_.crew) {
      options_.crew->each(planes.size(), score);
    } else {
      for (size_t i = 0; i < planes.size(); ++i) score(i);
    }
    std::vector<size_t> order(planes.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return volume[a] < volume[b]; });
    std::vector<CutPlane> sorted;
    for (const size_t i : order) sorted.push_back(planes[i]);
    return sorted;
  }

  /// For each slice across an axis: the least total volume of the hulls of the four parts that it
  /// leaves together with a slice across another axis. The slices are first among the planes,
  /// `slices` per axis.
  std::vector<double> pair_volumes(const TriangleMesh& mesh,
                                   std::span<const CutPlane> planes) const {
    constexpr size_t count = 3 * slices;
    std::vector<double> least(count, anywhere);
    std::vector<double> found(count * count, anywhere);
    const auto score = [&](size_t i) {
      for (size_t j = (i / slices + 1) * slices; j < count && !stop_requested(); ++j)
        found[i * count + j] = quarter_volume(mesh, planes[i].near, planes[j].near);
    };
    if (options_.crew) {
      options_.crew->each(count, score);
    } else {
      for (size_t i = 0; i < count; ++i) score(i);
    }
    for (size_t i = 0; i < count; ++i)
      for (size_t j = 0; j < count; ++j) {
        least[i] = std::min(least[i], found[i * count + j]);
        least[j] = std::min(least[j], found[i * count + j]);
      }
    return least;
  }

  /// Total volume of the hulls of the four parts between two planes, estimated from some of the
  /// vertices and of the points where edges cross either plane.
  double quarter_volume(const TriangleMesh& mesh, const Plane& p, const Plane& q) const {
    std::array<std::vector<Vec3>, 4> parts;
    const auto put = [&](const Vec3& x) {
      const double a = p.distance(x), b = q.distance(x);
      for (size_t k = 0; k < 4; ++k)
        if ((k & 1 ? a : -a) >= -tolerance_ && (k & 2 ? b : -b) >= -tolerance_)
          parts[k].push_back(x);
    };
    const size_t stride = mesh.vertices.size() / most_paired_points + 1;
    for (size_t v = 0; v < mesh.vertices.size(); v += stride) put(mesh.vertices[v]);
    size_t crossing = 0;
    for (const Triangle& t : mesh.triangles)
      for (size_t k = 0; k < 3; ++k) {
        const Vec3 &a = mesh.vertices[t[k]], &b = mesh.vertices[t[(k + 1) % 3]];
        for (const Plane* plane : {&p, &q}) {
          const double from = plane->distance(a), to = plane->distance(b);
          if (from < -tolerance_ && to > tolerance_ && crossing++ % stride == 0)
            put(a + from / (from - to) * (b - a));
        }
      }
    double volume = 0;
    for (const auto& part : parts) volume += hull_volume(part, tolerance_);
    return volume;
  }

  double split_volume(const TriangleMesh& mesh, const Plane& plane) const {
    std::vector<double> height(mesh.vertices.size());
    std::vector<Vec3> over, beneath;
    const size_t stride = mesh.vertices.size() / most_scored_points + 1;
    for (size_t v = 0; v < mesh.vertices.size(); ++v) {
      height[v] = plane.distance(mesh.vertices[v]);
      if (v % stride) continue;
      if (height[v] >= -tolerance_) over.push_back(mesh.vertices[v]);
      if (height[v] <= tolerance_) beneath.push_back(mesh.vertices[v]);
    }
    size_t crossing = 0;
    for (const Triangle& t : mesh.triangles)
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t a = t[k], b = t[(k + 1) % 3];
        // Each edge once, from the triangle in which it runs upwards.
        if (!(height[a] < -tolerance_ && height[b] > tolerance_) || crossing++ % stride) continue;
        const double s = height[a] / (height[a] - height[b]);
        const Vec3 p = mesh.vertices[a] + s * (mesh.vertices[b] - mesh.vertices[a]);
        over.push_back(p);
        beneath.push_back(p);
      }
    if (over.size() < 4 || beneath.size() < 4) return anywhere;
    return hull_volume(over, tolerance_) + hull_volume(beneath, tolerance_);
  }

  /// Merges neighbours while the bound holds, or while there are too many; those that add the least
  /// volume first.
  Status merge_all() {
    std::vector<Merger> mergers;
    for (size_t a = 0; a < parts_.size(); ++a)
      for (size_t b = 0; b < a; ++b) offer(b, a, Neighbours::only, mergers);
    std::vector<char> gone(parts_.size(), 0);
    for (;;) {
      if (stop_requested()) return stopped_error();
      const size_t left = parts_.size() - size_t(std::count(gone.begin(), gone.end(), 1));
      const bool must = left > options_.max_pieces;
      if (must && mergers.empty())  // the remaining parts are not adjacent
        for (size_t a = 0; a < parts_.size(); ++a)
          for (size_t b = 0; b < a; ++b)
            if (!gone[a] && !gone[b]) offer(b, a, Neighbours::or_not, mergers);
      const auto best = choose(mergers, must);
      if (best == mergers.end()) break;
      Merger merger = std::move(*best);
      gone[merger.a] = gone[merger.b] = 1;
      std::erase_if(mergers, [&](const Merger& m) {
        return m.a == merger.a || m.b == merger.a || m.a == merger.b || m.b == merger.b;
      });
      merger.result.stands_for = std::move(parts_[merger.a].stands_for);
      append(merger.result.stands_for, parts_[merger.b].stands_for);
      parts_.push_back(std::move(merger.result));
      gone.push_back(0);
      for (size_t n = 0; n + 1 < parts_.size(); ++n)
        if (!gone[n]) offer(n, parts_.size() - 1, Neighbours::only, mergers);
    }
    std::vector<Part> left;
    for (size_t n = 0; n < parts_.size(); ++n)
      if (!gone[n]) left.push_back(std::move(parts_[n]));
    parts_ = std::move(left);
    return {};
  }

  bool within_mesh(Merger& m) const {
    double& added = m.result.piece.added;
    if (m.reach == Merger::Reach::unknown) {
      added = reach(m.result, bound_);
      m.reach = added > bound_ ? Merger::Reach::too_far : Merger::Reach::known;
    }
    return m.reach == Merger::Reach::known && added <= bound_;
  }
  /// Whether the hull of a merger stays within the bound of the solids that it replaces. A hull
  /// that reaches into other parts is still inside the mesh, but overlapping hulls count their
  /// common volume twice.
  bool within_itself(Merger& m) const {
    if (m.hollow == Merger::Reach::unknown) {
      TriangleMesh both = parts_[m.a].stands_for;
      append(both, parts_[m.b].stands_for);
      const AabbTree solids(std::make_shared<const TriangleMesh>(std::move(both)));
      const double most = reach_outside(m.result.surface, solids, deciding_samples, bound_);
      m.hollow = most > bound_ ? Merger::Reach::too_far : Merger::Reach::known;
    }
    return m.hollow == Merger::Reach::known;
  }

  /// The merger that adds the least volume, of those whose hulls stay within the bound of the
  /// solids that they replace. If one `must` be chosen: of those within the bound of the mesh,
  /// otherwise the one that reaches the least outside.
  std::vector<Merger>::iterator choose(std::vector<Merger>& mergers, bool must) const {
    std::stable_sort(mergers.begin(), mergers.end(),
                     [](const Merger& a, const Merger& b) { return a.grown < b.grown; });
    for (auto m = mergers.begin(); m != mergers.end() && !stop_requested(); ++m)
      if (within_mesh(*m) && within_itself(*m)) return m;
    if (!must || stop_requested()) return mergers.end();
    const auto in_mesh =
        std::find_if(mergers.begin(), mergers.end(), [&](Merger& m) { return within_mesh(m); });
    if (in_mesh != mergers.end()) return in_mesh;
    for (Merger& m : mergers) {
      if (m.reach == Merger::Reach::known) continue;
      m.result.piece.added = reach(m.result, anywhere);
      m.reach = Merger::Reach::known;
    }
    return std::min_element(mergers.begin(), mergers.end(), [](const Merger& a, const Merger& b) {
      return a.result.piece.added < b.result.piece.added;
    });
  }

  enum class Neighbours : uint8_t { only, or_not };
  void offer(size_t a, size_t b, Neighbours which, std::vector<Merger>& mergers) const {
    if (stop_requested()) return;
    const Part &pa = parts_[a], &pb = parts_[b];
    if (which == Neighbours::only && !pa.box.inflated(tolerance_).overlaps(pb.box)) return;
    std::vector<Vec3> points = pa.piece.hull.vertices;
    points.insert(points.end(), pb.piece.hull.vertices.begin(), pb.piece.hull.vertices.end());
    auto hull = convex_hull(points);
    if (!hull) return;
    Merger m;
    m.a = a;
    m.b = b;
    m.result.piece.hull = std::move(hull->polyhedron);
    m.result.piece.solid = pa.piece.solid + pb.piece.solid;
    measure(m.result);
    m.grown = m.result.piece.volume - pa.piece.volume - pb.piece.volume;
    mergers.push_back(std::move(m));
  }

  Result<ConvexDecomposition> finish() {
    ConvexDecomposition out;
    out.mesh_volume = enclosed_volume(mesh_);
    out.concavity = bound_;
    out.cuts = cuts_;
    for (Part& part : parts_) {
      out.solid_volume += part.piece.solid;
      out.hull_volume += part.piece.volume;
      out.pieces.push_back(std::move(part.piece));
    }
    const HullError error = measure_hulls(out.pieces, surface_, reporting_samples);
    out.added = error.added;
    out.missing = error.missing;
    out.bound_met = true;
    for (const ConvexPiece& p : out.pieces) out.bound_met = out.bound_met && p.added <= bound_;
    return out;
  }

  const Hierarchy& surface_;
  const TriangleMesh& mesh_;
  const ApproximateDecompositionOptions& options_;
  double tolerance_ = 0, bound_ = 0;
  ExactSpace space_;
  std::vector<ReflexEdge> edges_;
  std::vector<Part> parts_;
  size_t cuts_ = 0;
};

}  // namespace

Result<ConvexDecomposition> decompose_approximately(
    const Hierarchy& surface, const ApproximateDecompositionOptions& options) {
  return ApproximateDecomposer(surface, options).run();
}

}  // namespace tumble
