#include "engine/geometry/mesh_cleanup.hpp"
#include "engine/geometry/mesh_orientation.hpp"
#include "engine/geometry/mesh_slivers.hpp"
#include "engine/geometry/mesh_topology.hpp"
#include "engine/geometry/predicates/orientation.hpp"
#include "engine/geometry/solid/fault_text.hpp"
#include "engine/geometry/solid/self_intersection.hpp"
#include "engine/geometry/solid/shells.hpp"
#include "engine/geometry/solid/solid_report.hpp"
#include "engine/geometry/solid/vertex_fans.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Checks one mesh for all kinds of faults, in their order.
class SolidCheck {
 public:
  SolidCheck(const TriangleMesh& mesh, const SolidOptions& options) : options_(options) {
    mesh_.vertices = mesh.vertices;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& c = mesh.triangles[t];
      const bool flat = collinear(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
      if (flat) degenerate_.push_back(t);
      // A triangle with a repeated corner is not part of the surface; one with collinear corners
      // may be, between a side and its halves.
      if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
      mesh_.triangles.push_back(c);
      id_.push_back(t);
    }
    topology_ = build_topology(mesh_);
    size_t count = 0;
    part_ = connected_parts(mesh_, &count);
    report_.shells = measure_shells(mesh_, topology_, part_, count);
  }

  SolidReport run() {
    open_borders();
    edges();
    orientation_faults();
    const std::vector<TriangleClash> clashes = options_.self_intersections
                                                   ? self_intersections(mesh_, &crowded_)
                                                   : std::vector<TriangleClash>{};
    intersections_and_shells(clashes);
    vertices();
    needle_folds();
    degenerates();
    duplicates();
    touching_pairs();
    report_.intersections_checked = options_.self_intersections;
    for (SolidShell& s : report_.shells) s.first_triangle = id_[s.first_triangle];
    std::stable_sort(report_.faults.begin(), report_.faults.end(),
                     [](const SolidFault& a, const SolidFault& b) { return a.kind < b.kind; });
    return std::move(report_);
  }

 private:
  /// Triangles whose height is below this share of their longest side are needles [-].
  static constexpr double needle = 1e-6;

  SolidFault& add(SolidFaultKind kind, size_t count) {
    SolidFault& f = report_.faults.emplace_back();
    f.kind = kind;
    f.count = count;
    f.blocks_mass = kind < SolidFaultKind::non_manifold_vertex;
    return f;
  }

  std::vector<uint32_t> original(std::vector<uint32_t> triangles) const {
    for (uint32_t& t : triangles) t = id_[t];
    return triangles;
  }

  void open_borders() {
    if (topology_.open_edges == 0) return;
    SolidFault& f = add(SolidFaultKind::open_border, topology_.open_edges);
    for (const MeshEdge& e : topology_.edges) {
      if (e.face_count != 1) continue;
      f.edges.push_back(e.vertices);
      f.triangles.push_back(id_[e.faces[0]]);
    }
    f.loops = find_holes(mesh_);
    f.text = fmt::format("the mesh is not closed: {} {}", fault_text::counted(f.count, "open edge"),
                         fault_text::named("vertices", f.edges));
    if (!f.loops.empty())
      f.text += fmt::format(" around {}", fault_text::counted(f.loops.size(), "hole"));
    const std::vector<uint32_t> lowest = lowest_equal_vertices(mesh_);
    size_t equal = 0;
    for (uint32_t v = 0; v < lowest.size(); ++v) equal += lowest[v] != v;
    f.cure = equal > 0 ? fmt::format(
                             "weld its vertices, {} of which lie upon others; fill its "
                             "holes, wrap it, or use its convex hull",
                             equal)
                       : "weld its vertices, fill its holes, wrap it, or use its convex hull";
  }

  void edges() {
    if (topology_.non_manifold_edges == 0) return;
    SolidFault& f = add(SolidFaultKind::non_manifold_edge, topology_.non_manifold_edges);
    for (const MeshEdge& e : topology_.edges) {
      if (e.face_count > 2) f.edges.push_back(e.vertices);
    }
    for (uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (uint32_t e : topology_.face_edges[t]) {
        if (e == no_index || topology_.edges[e].face_count <= 2) continue;
        f.triangles.push_back(id_[t]);
        break;
      }
    }
    f.text = fmt::format(
        "the mesh has no defined inside: {} {}, at which more than two triangles meet",
        fault_text::counted(f.count, "non-manifold edge"), fault_text::named("vertices", f.edges));
    f.cure = "clean the mesh, split it into parts, wrap it, or use its convex hull";
  }

  void orientation_faults() {
    if (topology_.misoriented_edges == 0) return;
    TriangleMesh oriented = mesh_;
    const OrientationReport turned = orient_consistently(oriented);
    std::vector<uint8_t> one_sided(report_.shells.size(), 0);
    for (uint32_t t : turned.unorientable) one_sided[part_[t]] = 1;
    SolidFault mixed, twisted;
    for (const MeshEdge& e : topology_.edges) {
      if (e.face_count != 2 || e.bend != EdgeBend::open) continue;
      (one_sided[part_[e.faces[0]]] ? twisted : mixed).edges.push_back(e.vertices);
    }
    if (!mixed.edges.empty()) {
      SolidFault& f = add(SolidFaultKind::misoriented, mixed.edges.size());
      f.edges = std::move(mixed.edges);
      f.triangles = original(turned.flipped);
      f.text = fmt::format("the mesh is not consistently oriented: {} {}",
                           fault_text::counted(f.count, "misoriented edge"),
                           fault_text::named("vertices", f.edges));
      if (!f.triangles.empty()) {
        f.text += fmt::format(
            "; {} {} {} against the others", fault_text::counted(f.triangles.size(), "triangle"),
            fault_text::named("numbers", f.triangles), f.triangles.size() == 1 ? "runs" : "run");
      }
      f.cure = "orient its triangles, or use its convex hull";
    }
    if (!turned.unorientable.empty()) {
      SolidFault& f = add(SolidFaultKind::one_sided, turned.unorientable.size());
      f.edges = std::move(twisted.edges);
      f.triangles = original(turned.unorientable);
      f.text = fmt::format(
          "{} of the mesh {} one-sided, like a Moebius strip or a Klein bottle {}: no "
          "order of corners agrees everywhere",
          fault_text::counted(f.count, "part"), f.count == 1 ? "is" : "are",
          fault_text::named("from triangle", f.triangles));
      f.cure = "cut it open along a seam and give it thickness, wrap it, or use its convex hull";
    }
  }

  /// Whether one of two neighbours that lie upon each other is a needle: that is not a
  /// self-intersection of the surface, but a vertex rounded to the wrong side of an edge, and
  /// encloses practically no volume.
  bool folded_needle(const TriangleIds& ids) const {
    const Triangle &a = mesh_.triangles[ids.a], &b = mesh_.triangles[ids.b];
    size_t shared = 0;
    for (const uint32_t v : a) shared += v == b[0] || v == b[1] || v == b[2];
    return shared == 2 && (needle_height(a) > 0 || needle_height(b) > 0);
  }
  /// Height of a triangle that is a needle [m], otherwise 0.
  double needle_height(const Triangle& t) const {
    const double height = triangle_height(mesh_, t);
    double longest = 0;
    for (size_t k = 0; k < 3; ++k)
      longest = std::max(longest, (mesh_.vertices[t[(k + 1) % 3]] - mesh_.vertices[t[k]]).norm());
    return height <= needle * longest ? height : 0;
  }

  void needle_folds() {
    if (needles_.empty()) return;
    SolidFault& f = add(SolidFaultKind::needle_fold, needles_.size());
    double highest = 0;
    for (const TriangleIds& ids : needles_) {
      f.pairs.push_back({id_[ids.a], id_[ids.b]});
      for (const uint32_t t : {ids.a, ids.b}) {
        const double height = needle_height(mesh_.triangles[t]);
        if (height > 0) f.triangles.push_back(id_[t]);
        highest = std::max(highest, height);
      }
    }
    std::sort(f.triangles.begin(), f.triangles.end());
    f.triangles.erase(std::unique(f.triangles.begin(), f.triangles.end()), f.triangles.end());
    f.text = fmt::format("{} at most {:.2g} m high folded back upon {} {}",
                         f.count == 1 ? "1 needle" : fmt::format("{} needles", f.count), highest,
                         f.count == 1 ? "its neighbour" : "their neighbours",
                         fault_text::named("numbers", f.pairs));
    f.cure = fmt::format("weld within {:.1g} m", 2 * highest);
  }

  void intersections_and_shells(const std::vector<TriangleClash>& clashes) {
    std::vector<TriangleIds> clash_of_shells, bad;
    for (const TriangleClash& c : clashes) {
      const bool two_shells = part_[c.ids.a] != part_[c.ids.b];
      const bool through = c.relation == TriangleRelation::crossing;
      const bool upon =
          c.relation == TriangleRelation::overlapping && (!two_shells || c.same_facing);
      if (upon && !two_shells && folded_needle(c.ids)) {
        needles_.push_back(c.ids);
      } else if (through || upon) {
        bad.push_back(c.ids);
      } else {
        (two_shells ? clash_of_shells : touching_).push_back(c.ids);
      }
    }
    std::vector<uint8_t> crossed(report_.shells.size(), 0);
    for (const TriangleIds& ids : bad) {
      if (part_[ids.a] != part_[ids.b]) crossed[part_[ids.a]] = crossed[part_[ids.b]] = 1;
    }
    ShellNesting nesting = nest_shells(mesh_, part_, report_.shells, crossed, clash_of_shells);
    std::vector<TriangleIds> harmless;
    std::set_difference(clash_of_shells.begin(), clash_of_shells.end(), nesting.crossings.begin(),
                        nesting.crossings.end(), std::back_inserter(harmless));
    touching_.insert(touching_.end(), harmless.begin(), harmless.end());
    bad.insert(bad.end(), nesting.crossings.begin(), nesting.crossings.end());
    std::sort(bad.begin(), bad.end());
    if (!bad.empty()) self_intersection(bad);
    shells(nesting, bad);
  }

  void self_intersection(const std::vector<TriangleIds>& pairs) {
    SolidFault& f = add(SolidFaultKind::self_intersection, pairs.size());
    for (const TriangleIds& ids : pairs) {
      f.pairs.push_back({id_[ids.a], id_[ids.b]});
      f.triangles.push_back(id_[ids.a]);
      f.triangles.push_back(id_[ids.b]);
    }
    std::sort(f.triangles.begin(), f.triangles.end());
    f.triangles.erase(std::unique(f.triangles.begin(), f.triangles.end()), f.triangles.end());
    f.text = fmt::format(
        "the mesh passes through itself: {} of triangles that cross or lie upon each "
        "other {}",
        fault_text::counted(f.count, "pair"), fault_text::named("numbers", f.pairs));
    f.cure =
        "unite its parts in a modelling program, make each a shape of its own, wrap it, or use "
        "its convex hull";
  }

  void shells(const ShellNesting& nesting, const std::vector<TriangleIds>& crossing) {
    std::vector<Aabb> box(report_.shells.size());
    for (uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (size_t k = 0; k < 3; ++k) box[part_[t]].include(mesh_.corner(t, k));
    }
    std::vector<uint8_t> crosses(report_.shells.size(), 0);
    for (const TriangleIds& ids : crossing) {
      if (part_[ids.a] != part_[ids.b]) crosses[part_[ids.a]] = crosses[part_[ids.b]] = 1;
    }
    std::vector<uint32_t> turned, doubled, flat;
    size_t closed = 0;
    for (size_t i = 0; i < report_.shells.size(); ++i) {
      SolidShell& s = report_.shells[i];
      s.depth = nesting.depth[i];
      if (!s.closed) continue;
      ++closed;
      const double extent = box[i].extent().maxCoeff();
      if (std::fabs(s.volume) <= 1e-14 * extent * extent * extent) {
        flat.push_back(s.first_triangle);
        continue;
      }
      // The winding number that the other shells give to its outside: solid (1) or empty (0);
      // crossing shells have no unique answer.
      const int outside = crosses[i] ? (s.volume > 0 ? 0 : 1) : nesting.winding[i];
      if (s.volume > 0 && outside > 0) doubled.push_back(s.first_triangle);
      if ((s.volume < 0 && outside <= 0) || (s.volume > 0 && outside < 0)) {
        turned.push_back(s.first_triangle);
      }
      report_.cavities += s.volume < 0 && outside == 1;
    }
    if (!turned.empty()) {
      SolidFault& f = add(SolidFaultKind::inside_out, turned.size());
      f.triangles = original(turned);
      f.text =
          report_.shells.size() == 1
              ? fmt::format("the mesh is inside-out: its volume is {:.6g} m^3",
                            report_.shells[0].volume)
              : fmt::format("the mesh is inside-out in {} {}", fault_text::counted(f.count, "part"),
                            fault_text::named("from triangle", f.triangles));
      f.cure = "reverse the order of the corners of every triangle of it, or orient the mesh";
    }
    if (!doubled.empty()) {
      SolidFault& f = add(SolidFaultKind::counted_twice, doubled.size());
      f.triangles = original(doubled);
      f.text = fmt::format(
          "{} within another one and faces outwards, so that its inside counts twice {}",
          f.count == 1 ? "1 part lies" : fmt::format("{} parts lie", f.count),
          fault_text::named("from triangle", f.triangles));
      f.cure = "turn it to make it a hollow, remove it, or use the convex hull";
    }
    // Flat parts are harmless if there are others.
    if (flat.size() == closed && (closed > 0 || mesh_.triangles.empty())) {
      SolidFault& f = add(SolidFaultKind::no_volume, std::max<size_t>(closed, 1));
      f.triangles = original(flat);
      f.text = "the mesh encloses no volume";
      f.cure = "give it thickness, or wrap it";
    }
  }

  void vertices() {
    const std::vector<uint32_t> pinched = non_manifold_vertices(mesh_, topology_);
    if (pinched.empty()) return;
    SolidFault& f = add(SolidFaultKind::non_manifold_vertex, pinched.size());
    f.vertices = pinched;
    f.text =
        fmt::format("{} {}: surfaces meet there in a single point",
                    fault_text::counted(f.count, "non-manifold vertex", "non-manifold vertices"),
                    fault_text::named("numbers", f.vertices));
    f.cure = "split the mesh into parts if they should be apart";
  }

  void degenerates() {
    if (degenerate_.empty()) return;
    SolidFault& f = add(SolidFaultKind::degenerate_triangle, degenerate_.size());
    f.triangles = degenerate_;
    f.text = fmt::format("{} without area {}", fault_text::counted(f.count, "triangle"),
                         fault_text::named("numbers", f.triangles));
    f.cure = "clean the mesh to drop those with equal corners";
  }

  void duplicates() {
    std::vector<std::pair<Triangle, uint32_t>> keys;
    for (uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      Triangle key = mesh_.triangles[t];
      std::sort(key.begin(), key.end());
      keys.emplace_back(key, t);
    }
    std::sort(keys.begin(), keys.end());
    std::vector<TriangleIds> pairs;  // each with the first triangle of its kind
    for (size_t i = 1, first = 0; i < keys.size(); ++i) {
      if (keys[i].first != keys[first].first) first = i;
      if (i != first) pairs.push_back({id_[keys[first].second], id_[keys[i].second]});
    }
    if (pairs.empty()) return;
    std::sort(pairs.begin(), pairs.end());
    SolidFault& f = add(SolidFaultKind::duplicate_triangle, pairs.size());
    f.pairs = std::move(pairs);
    for (const TriangleIds& ids : f.pairs) f.triangles.push_back(ids.b);
    f.text =
        fmt::format("{} the three corners of another one {}",
                    f.count == 1 ? "1 triangle has" : fmt::format("{} triangles have", f.count),
                    fault_text::named("numbers", f.pairs));
    f.cure = "clean the mesh to drop them";
  }

  void touching_pairs() {
    if (touching_.empty() && crowded_.empty()) return;
    std::sort(touching_.begin(), touching_.end());
    SolidFault& f = add(SolidFaultKind::touching, touching_.size());
    for (const TriangleIds& ids : touching_) f.pairs.push_back({id_[ids.a], id_[ids.b]});
    f.vertices = crowded_;
    f.text =
        fmt::format("the mesh touches itself without crossing: {} of triangles {}",
                    fault_text::counted(f.count, "pair"), fault_text::named("numbers", f.pairs));
    if (!crowded_.empty()) {
      f.text += fmt::format("; too many triangles meet at {} to look for crossings there",
                            fault_text::named("vertices", crowded_));
    }
  }

  SolidOptions options_;
  TriangleMesh mesh_;         // without triangles that repeat a corner
  std::vector<uint32_t> id_;  // numbers of its triangles in the given mesh
  std::vector<uint32_t> degenerate_;
  MeshTopology topology_;
  std::vector<uint32_t> part_;
  std::vector<TriangleIds> touching_, needles_;
  std::vector<uint32_t> crowded_;
  SolidReport report_;
};

}  // namespace

SolidReport check_solid(const TriangleMesh& mesh, const SolidOptions& options) {
  if (const Status ok = validate(mesh); !ok) {
    SolidReport report;
    SolidFault& f = report.faults.emplace_back();
    f.count = 1;
    f.text = ok.error().message;
    f.cure = ok.error().cure;
    return report;
  }
  return SolidCheck(mesh, options).run();
}

}  // namespace tumble
