#include "engine/collision/convex_pairs/face_clipping.hpp"

#include "engine/collision/feature_key.hpp"
#include "engine/math/rotation.hpp"

#include <cmath>

namespace tumble {
namespace {

/// Faces steeper than this against the contact plane carry no area.
constexpr double min_alignment = 0.05;

/// A corner of the polygon being clipped: position in the contact plane, and height along the
/// normal on the subject's face. `side` labels the side that leaves it: the subject's (low bit 0)
/// or one of the clipping polygon's (low bit 1).
struct Corner {
  double u, v, height;
  uint64_t side;
};

/// Height of a face over the contact plane as a linear function.
struct Height {
  double h0 = 0, hu = 0, hv = 0;
  double at(double u, double v) const { return h0 + hu * u + hv * v; }
};

struct Plane2 {
  Vec3 t1, t2, n;
  Corner place(const Vec3& p) const { return {p.dot(t1), p.dot(t2), p.dot(n), 0}; }
};

constexpr int capacity = 2 * SupportingFace::capacity + 8;

struct Polygon {
  std::array<Corner, size_t(capacity)> corners;
  int count = 0;
  void add(const Corner& c) {
    if (count < capacity) corners[size_t(count++)] = c;
  }
};

/// The face's plane by Newell's normal. False when it is too steep.
bool height_of(const SupportingFace& f, const Plane2& plane, Height& h) {
  const Vec3 first = f.points[0];
  Vec3 normal = Vec3::Zero(), middle = first, side = f.points[1] - first;
  middle += f.points[1];
  for (int i = 2; i < f.count; ++i) {
    const Vec3& p = f.points[size_t(i)];
    const Vec3 next = p - first;
    normal += side.cross(next);
    middle += p;
    side = next;
  }
  middle /= f.count;
  const double length = normal.norm();
  if (!(length > 0)) return false;
  normal /= length;
  const double along = normal.dot(plane.n);
  if (std::abs(along) < min_alignment) return false;
  h.hu = -normal.dot(plane.t1) / along;
  h.hv = -normal.dot(plane.t2) / along;
  const Corner m = plane.place(middle);
  h.h0 = m.height - h.hu * m.u - h.hv * m.v;
  return true;
}

uint64_t side_label(const SupportingFace& f, int i, bool subject) {
  const int j = i + 1 == f.count ? 0 : i + 1;
  const uint64_t e = edge_key(f.ids[size_t(i)], f.ids[size_t(j)]);
  return mix_key(subject ? 0 : 1, e) << 1 | (subject ? 0 : 1);
}

/// A polygon, and the part that remains when it is clipped.
class Cutting {
 public:
  Polygon& polygon() { return polygons_[now_]; }

  /// Keeps the part on the left of the line from p to q. `label()` is the label of the clipping
  /// side.
  template <class Label>
  void cut(const Corner& p, const Corner& q, bool open, const Label& label) {
    const Polygon& in = polygons_[now_];
    const double du = q.u - p.u, dv = q.v - p.v;
    std::array<double, size_t(capacity)> sides;
    int left = 0;
    for (int i = 0; i < in.count; ++i) {
      const Corner& c = in.corners[size_t(i)];
      const double s = du * (c.v - p.v) - dv * (c.u - p.u);
      sides[size_t(i)] = s;
      left += s >= 0;
    }
    if (left == in.count) return;
    now_ = 1 - now_;
    Polygon& out = polygons_[now_];
    out.count = 0;
    if (left == 0) return;
    const uint64_t cutter = label();
    for (int i = 0; i < in.count; ++i) {
      const Corner& c = in.corners[size_t(i)];
      const double sc = sides[size_t(i)];
      if (sc >= 0) out.add(c);
      if (open && i + 1 == in.count) break;  // a segment has one side only
      const size_t j = i + 1 == in.count ? 0 : size_t(i + 1);
      const double sd = sides[j];
      if ((sc >= 0) == (sd >= 0)) continue;
      const Corner& d = in.corners[j];
      const double t = sc / (sc - sd);
      out.add({c.u + t * (d.u - c.u), c.v + t * (d.v - c.v), c.height + t * (d.height - c.height),
               sc >= 0 || open ? cutter : c.side});
    }
  }

 private:
  std::array<Polygon, 2> polygons_;
  size_t now_ = 0;
};

/// The key of a corner from the labels of the sides that meet there: two of the subject, one of
/// each, or two of the clipping polygon. Symmetric, so that it does not depend on which face was
/// clipped.
uint64_t corner_key(uint64_t in, uint64_t out, bool subject_is_a) {
  const bool in_cutter = in & 1, out_cutter = out & 1;
  const uint64_t x = in >> 1, y = out >> 1;
  if (in_cutter != out_cutter) {
    const uint64_t subject = in_cutter ? y : x, cutter = in_cutter ? x : y;
    return subject_is_a ? feature_key(FeaturePair::edge_edge, subject, cutter)
                        : feature_key(FeaturePair::edge_edge, cutter, subject);
  }
  const bool of_a = in_cutter != subject_is_a;
  return feature_key(of_a ? FeaturePair::vertex_face : FeaturePair::face_vertex, x ^ y, x + y);
}

void clip_by(const SupportingFace& subject, const SupportingFace& cutter, const Plane2& plane,
             bool subject_is_a, const Height& cutter_height, double rounding_a, double rounding_b,
             double margin, ManifoldBuilder& out) {
  Cutting cutting;
  for (int i = 0; i < subject.count; ++i) {
    Corner c = plane.place(subject.points[size_t(i)]);
    c.side = side_label(subject, i, true);
    cutting.polygon().add(c);
  }
  const bool open = subject.count == 2;
  // A is counter-clockwise about the normal, B clockwise.
  const bool backwards = subject_is_a;
  const Corner first = plane.place(cutter.points[0]);
  Corner p = first;
  for (int i = 0; i < cutter.count && cutting.polygon().count > 0; ++i) {
    const Corner q = i + 1 == cutter.count ? first : plane.place(cutter.points[size_t(i + 1)]);
    cutting.cut(backwards ? q : p, backwards ? p : q, open,
                [&] { return side_label(cutter, i, false); });
    p = q;
  }
  const Polygon& polygon = cutting.polygon();
  for (int i = 0; i < polygon.count; ++i) {
    const Corner& c = polygon.corners[size_t(i)];
    const Corner& before = polygon.corners[size_t((i == 0 ? polygon.count : i) - 1)];
    const double other = cutter_height.at(c.u, c.v);
    const double on_a = (subject_is_a ? c.height : other) + rounding_a;
    const double on_b = (subject_is_a ? other : c.height) - rounding_b;
    const double gap = on_b - on_a;
    if (gap > margin) continue;
    const Vec3 x = c.u * plane.t1 + c.v * plane.t2 + 0.5 * (on_a + on_b) * plane.n;
    // ends of a segment are told apart by which of the two they are
    const uint64_t in = open ? (uint64_t(i) << 1) : before.side;
    out.add(x, gap, corner_key(in, c.side, subject_is_a));
  }
}

/// Two nearly parallel segments: the ends of their overlap.
void clip_segments(const SupportingFace& a, const SupportingFace& b, const Plane2& plane,
                   double rounding_a, double rounding_b, double margin, ManifoldBuilder& out) {
  const Vec3 da = a.points[1] - a.points[0], db = b.points[1] - b.points[0];
  const double la = da.norm(), lb = db.norm();
  if (!(la > 0) || !(lb > 0)) return;
  if (da.cross(db).norm() > 0.05 * la * lb) return;
  const Vec3 axis = da / la;
  for (int end = 0; end < 4; ++end) {
    const bool of_a = end < 2;
    const Vec3& p = of_a ? a.points[size_t(end)] : b.points[size_t(end - 2)];
    const Vec3& q0 = of_a ? b.points[0] : a.points[0];
    const Vec3 dq = of_a ? db : da;
    const double t = (p - q0).dot(axis) / dq.dot(axis);
    if (!(t >= 0 && t <= 1)) continue;
    const Vec3 q = q0 + t * dq;
    const double on_a = plane.n.dot(of_a ? p : q) + rounding_a;
    const double on_b = plane.n.dot(of_a ? q : p) - rounding_b;
    if (on_b - on_a > margin) continue;
    const Vec3 middle = 0.5 * (p + q);
    const Vec3 x = middle + (0.5 * (on_a + on_b) - plane.n.dot(middle)) * plane.n;
    const uint32_t id = of_a ? a.ids[size_t(end)] : b.ids[size_t(end - 2)];
    out.add(x, on_b - on_a,
            feature_key(of_a ? FeaturePair::vertex_face : FeaturePair::face_vertex, id, 1));
  }
}

}  // namespace

void clip_faces(const SupportingFace& a, const SupportingFace& b, const Vec3& normal,
                double rounding_a, double rounding_b, double margin, ManifoldBuilder& out) {
  if (a.count < 2 || b.count < 2) return;
  Plane2 plane;
  plane.n = normal;
  tangent_frame(normal, plane.t1, plane.t2);
  Height height;
  if (a.count >= 3) {
    if (height_of(a, plane, height))
      clip_by(b, a, plane, false, height, rounding_a, rounding_b, margin, out);
  } else if (b.count >= 3) {
    if (height_of(b, plane, height))
      clip_by(a, b, plane, true, height, rounding_a, rounding_b, margin, out);
  } else {
    clip_segments(a, b, plane, rounding_a, rounding_b, margin, out);
  }
}

}  // namespace tumble
