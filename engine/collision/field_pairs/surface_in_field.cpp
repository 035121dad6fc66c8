#include "engine/collision/field_pairs/surface_in_field.hpp"

#include "engine/collision/feature_key.hpp"
#include "engine/core/stop.hpp"

#include <algorithm>
#include <limits>

namespace tumble {

bool sticks_out_along(const PlacedSurface& S, uint32_t vertex, const Vec3& inward, double sine) {
  const Vec3 along = S.local_direction(inward);
  const Vec3& p = S.s.vertex(vertex);
  for (const uint32_t e : S.s.topology.edges_of_vertex(vertex)) {
    const auto& ends = S.s.topology.edges[e].vertices;
    const Vec3 side = S.s.vertex(ends[0] == vertex ? ends[1] : ends[0]) - p;
    const double reach = side.dot(along);
    if (reach > 0 && reach * reach > sine * sine * side.squaredNorm()) return false;
  }
  return true;
}

namespace {

/// Samples of the field at the vertices of a surface, each computed once.
class VertexSamples {
 public:
  void begin(size_t vertices) {
    ++now_;
    if (stamp_.size() >= vertices) return;
    stamp_.resize(vertices, 0);
    samples_.resize(vertices);
  }
  const FieldPoint& at(const PlacedSurface& S, const DistanceField& field, uint32_t vertex) {
    if (stamp_[vertex] != now_) {
      stamp_[vertex] = now_;
      samples_[vertex] = field_point(field, S.vertex(vertex));
    }
    return samples_[vertex];
  }

 private:
  std::vector<uint64_t> stamp_;
  std::vector<FieldPoint> samples_;
  uint64_t now_ = 0;
};

/// Search for the contacts of one surface and one field.
class SurfaceSearch {
 public:
  SurfaceSearch(const PlacedSurface& S, const DistanceField& field, double margin,
                FieldSearch search, VertexSamples& samples, std::vector<FeatureContact>& out)
      : S_(S),
        field_(field),
        margin_(margin),
        piece_(tolerances::edge_piece * field.cell()),
        search_(search),
        samples_(samples),
        out_(out) {}

  double run() {
    const AabbTree& tree = *S_.s.tree;
    const auto& nodes = tree.nodes();
    thread_local std::vector<uint32_t> stack;
    stack.assign(nodes.empty() ? 0 : 1, 0);
    while (!stack.empty() && !stop_requested()) {
      const uint32_t i = stack.back();
      stack.pop_back();
      const Aabb box = node_box(tree, i);
      const double least =
          field_point(field_, S_.point(box.centre())).least_within(0.5 * box.extent().norm());
      if (least > margin_) {
        apart_ = std::min(apart_, least);
        continue;
      }
      if (!nodes[i].is_leaf()) {
        stack.push_back(nodes[i].start);
        stack.push_back(i + 1);
        continue;
      }
      apart_ = std::min(apart_, margin_);
      for (uint32_t k = 0; k < nodes[i].count; ++k)
        triangle(tree.triangle_order()[nodes[i].start + k]);
    }
    return apart_;
  }

 private:
  void triangle(uint32_t t) {
    face(t);
    const unsigned owned = S_.s.owned[t];
    if (owned == 0) return;
    const Triangle& ids = S_.s.mesh->triangles[t];
    for (unsigned k = 0; k < 3; ++k) {
      if (owned & (1u << k)) corner(ids[k]);
      if (search_ == FieldSearch::corners || !(owned & (8u << k))) continue;
      const uint32_t e = S_.s.topology.face_edges[t][k];
      const MeshEdge& edge = S_.s.topology.edges[e];
      piece_number_ = 0;
      piece(e, samples_.at(S_, field_, edge.vertices[0]),
            samples_.at(S_, field_, edge.vertices[1]));
    }
  }

  /// If a corner of a face that is large relative to the field lies at an edge of the field's mesh,
  /// the gradient there points to the other side of that edge, and the corner says nothing about
  /// the contact of the two faces. Their common area begins farther inside: it is searched for from
  /// the corner towards the centre of the triangle's inscribed circle.
  void face(uint32_t t) {
    const Triangle& ids = S_.s.mesh->triangles[t];
    const Vec3 a = S_.vertex(ids[0]), b = S_.vertex(ids[1]), c = S_.vertex(ids[2]);
    const double la = (b - c).norm(), lb = (c - a).norm(), lc = (a - b).norm();
    const double around = la + lb + lc;
    const double inner = (b - a).cross(c - a).norm() / around;
    if (!(inner > piece_)) return;
    const Vec3 middle = (la * a + lb * b + lc * c) / around, inward = -S_.face_normal(t);
    const auto fits = [&](const FieldPoint& p) {
      return p.has_direction() && p.normal().dot(inward) > tolerances::face_to_face;
    };
    for (const uint32_t v : ids) {
      const FieldPoint& at = samples_.at(S_, field_, v);
      if (at.distance > margin_ || fits(at)) continue;
      for (double part = piece_ / inner; part < 1; part *= 2) {
        const FieldPoint p = field_point(field_, at.x + part * (middle - at.x));
        if (p.distance > margin_ || !fits(p)) continue;
        add(p, p.normal(), feature_key(FeaturePair::vertex_face, v, t + 1));
        break;
      }
    }
  }

  void corner(uint32_t v) {
    const FieldPoint& p = samples_.at(S_, field_, v);
    if (p.distance > margin_ || !p.has_direction()) return;
    const Vec3 n = p.normal();
    const double cone = p.distance < 0 ? tolerances::cone_inside : tolerances::cone_in_front;
    if (!sticks_out_along(S_, v, -n, cone)) return;
    add(p, n, feature_key(FeaturePair::vertex_face, v, 0));
  }

  void add(const FieldPoint& p, const Vec3& n, uint64_t key) {
    out_.push_back({p.x - 0.5 * p.distance * n, n, p.distance, key});
  }

  /// Searches a piece of an edge between two points, which is divided until it is no longer than
  /// the field's detail.
  void piece(uint32_t e, const FieldPoint& a, const FieldPoint& b) {
    const Vec3 way = b.x - a.x;
    const double length = way.norm();
    const double least = 0.5 * (a.distance - a.error + b.distance - b.error - length);
    if (least > margin_ || !(length > 0)) return;
    if (length > piece_) {
      const FieldPoint middle = field_point(field_, a.x + 0.5 * way);
      piece(e, a, middle);
      piece(e, middle, b);
      return;
    }
    lowest(e, a, b, way / length);
    ++piece_number_;
  }

  /// Finds where along the piece the distance stops decreasing or starts to increase, if it does:
  /// at a lowest point, or at the end of a stretch of constant distance. The normal there is that
  /// of the stretch, or the part of the gradient perpendicular to the edge: in cells at an edge of
  /// the field's mesh gradients are tilted to the other side.
  void lowest(uint32_t e, FieldPoint a, FieldPoint b, const Vec3& along) {
    constexpr double level = tolerances::level_slope;
    const double at_a = a.gradient.dot(along), at_b = b.gradient.dot(along);
    if (at_a > level || at_b < -level || (at_a >= -level && at_b <= level)) return;
    const double wanted = at_a >= -level ? level : at_b <= level ? -level : 0;
    const Vec3 of_level = wanted > 0 ? a.gradient : b.gradient;
    for (int i = 0; i < tolerances::edge_halvings; ++i) {
      const FieldPoint middle = field_point(field_, 0.5 * (a.x + b.x));
      (middle.gradient.dot(along) < wanted ? a : b) = middle;
    }
    FieldPoint& p = a.distance < b.distance ? a : b;
    if (wanted != 0) p.gradient = of_level;
    p.gradient -= p.gradient.dot(along) * along;
    if (p.distance > margin_ || !p.has_direction()) return;
    const Vec3 n = p.normal();
    if (S_.direction(S_.s.topology.edges[e].normal).dot(n) > -tolerances::edge_outside) return;
    add(p, n, feature_key(FeaturePair::edge_edge, e, piece_number_));
  }

  const PlacedSurface& S_;
  const DistanceField& field_;
  double margin_, piece_;
  FieldSearch search_;
  VertexSamples& samples_;
  std::vector<FeatureContact>& out_;
  double apart_ = std::numeric_limits<double>::infinity();
  uint64_t piece_number_ = 0;
};

}  // namespace

double surface_in_field(const PlacedSurface& S, const DistanceField& field, double margin,
                        FieldSearch search, std::vector<FeatureContact>& contacts) {
  thread_local VertexSamples samples;
  samples.begin(S.s.mesh->vertices.size());
  return SurfaceSearch(S, field, margin, search, samples, contacts).run();
}

}  // namespace tumble
