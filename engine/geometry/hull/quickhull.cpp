#include "engine/geometry/hull/quickhull.hpp"

#include "engine/geometry/hull/triangle_shape.hpp"
#include "engine/geometry/predicates/orientation.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

// Quickhull with exact visibility. Because "above" is decided exactly, the faces visible from a
// point always form a disc with a simple horizon, every new triangle has area, and the surface
// stays closed and convex for any input.
//
// Each point outside is listed at one face that it is exactly above. It is dropped once it is
// inside, or within the tolerance of a triangle of the hull; since the hull only grows, it stays
// that near. Most points are decided by their floating-point height above a face; exact arithmetic
// is only needed for points in the plane of a face but away from its triangle.
namespace tumble {
namespace {

struct QuickhullFace {
  Vec3 normal, corner;  // corner is v[0]
  double uncertainty;   // error bound of height() [m]
  double highest;       // height of the highest point listed here [m]
  uint32_t apex;        // the highest of them
  uint32_t first;       // first point of the face's list, which is linked by next_
  uint32_t mark;        // number of the last search that found this face visible
  bool queued = false;  // it is in a queue
  Triangle v;
  std::array<uint32_t, 3> next;  // the face across side k

  double height(const Vec3& p) const { return normal.dot(p - corner); }
};

class Quickhull {
 public:
  Quickhull(std::span<const Vec3> points, double tolerance)
      : points_(points), tolerance_(tolerance) {
    Aabb box;
    for (const Vec3& p : points) box.include(p);
    extent_ = box.extent().norm();
    good_normal_ = tolerance_ / (16 * extent_);
  }

  Result<std::vector<HullTriangle>> run() {
    if (Status ok = start(); !ok) return ok.error();
    while (next_queue()) {
      while (!queue_.empty()) {
        const uint32_t f = queue_.back();
        queue_.pop_back();
        faces_[f].queued = false;
        if (faces_[f].first == no_index) continue;
        if (urgency(faces_[f]) < threshold_) {
          enqueue(f, later_);
        } else if (faces_[f].highest > faces_[f].uncertainty && faces_[f].highest > tolerance_) {
          const uint32_t apex = faces_[f].apex;
          find_visible(f, apex);
          add_point(apex);
        } else {
          add_leftovers(f);
        }
      }
    }
    return collect();
  }

 private:
  /// Greatest height of the points of a face, at least the tolerance [m].
  double urgency(const QuickhullFace& f) const { return std::max(f.highest, tolerance_); }

  void enqueue(uint32_t f, std::vector<uint32_t>& queue) {
    if (faces_[f].queued) return;
    faces_[f].queued = true;
    queue.push_back(f);
  }

  /// Processes faces by height in steps of an eighth, so that the hull grows evenly and no point
  /// sees very many faces. Among those of about equal height the newest comes first, since its
  /// surroundings are still in the cache.
  bool next_queue() {
    double highest = 0;
    for (uint32_t f : later_) {
      if (faces_[f].first != no_index) highest = std::max(highest, urgency(faces_[f]));
    }
    threshold_ = highest / 8;
    queue_.assign(later_.rbegin(), later_.rend());
    later_.clear();
    return !queue_.empty();
  }

  bool is_above(const QuickhullFace& f, uint32_t p) const {
    const double h = f.height(points_[p]);
    if (h > f.uncertainty) return true;
    if (h < -f.uncertainty) return false;
    return orientation(f.corner, points_[f.v[1]], points_[f.v[2]], points_[p]) > 0;
  }

  double distance(const QuickhullFace& f, double height, const Vec3& p) const {
    return distance_to_triangle(f.corner, points_[f.v[1]], points_[f.v[2]], f.normal, height, p);
  }

  uint32_t new_face() {
    if (free_.empty()) {
      faces_.emplace_back();
      return uint32_t(faces_.size() - 1);
    }
    const uint32_t f = free_.back();
    free_.pop_back();
    return f;
  }

  void set_face(uint32_t f, uint32_t a, uint32_t b, uint32_t c) {
    QuickhullFace& face = faces_[f];
    const TriangleShape shape = triangle_shape(points_[a], points_[b], points_[c], good_normal_);
    face.normal = shape.normal;
    face.corner = points_[a];
    // Five roundings of the difference and the product, and the error of the normal.
    face.uncertainty = extent_ * (8 * 0x1p-53 + shape.uncertain);
    face.highest = 0;
    face.apex = face.first = no_index;
    face.mark = 0;
    face.v = {a, b, c};
  }

  void hang(QuickhullFace& face, uint32_t p, double height) {
    if (face.first == no_index || height > face.highest) {
      face.highest = height;
      face.apex = p;
    }
    next_[p] = face.first;
    face.first = p;
  }

  /// Lists `p` at one of the new faces, or drops it.
  void assign(uint32_t p) {
    const Vec3& x = points_[p];
    bool doubtful = false;
    for (uint32_t f : fresh_) {
      QuickhullFace& face = faces_[f];
      const double h = face.height(x);
      if (h < -face.uncertainty) continue;
      if (h > tolerance_ && h > face.uncertainty) return hang(face, p, h);
      if (distance(face, h, x) <= tolerance_) return;
      doubtful = true;
    }
    if (!doubtful) return;
    for (uint32_t f : fresh_) {
      if (is_above(faces_[f], p)) return hang(faces_[f], p, faces_[f].height(x));
    }
  }

  template <class Measure>
  std::pair<uint32_t, double> most(const Measure& measure) const {
    uint32_t best = 0;
    double value = -1;
    for (uint32_t p = 0; p < points_.size(); ++p) {
      const double m = measure(points_[p]);
      if (m > value) {
        value = m;
        best = p;
      }
    }
    return {best, value};
  }

  Error degenerate(const char* what, double size, const char* cure) const {
    return {ErrorCode::invalid_argument,
            fmt::format("the {} points {}: {:.3g} m, where {:.3g} m is the least", points_.size(),
                        what, size, 4 * tolerance_),
            {},
            cure};
  }

  /// Makes a tetrahedron of distant points and lists every other point at one of its faces.
  Status start() {
    const double least = 4 * tolerance_;
    const auto from = [](const Vec3& o) {
      return [o](const Vec3& p) { return (p - o).squaredNorm(); };
    };
    const uint32_t a = most(from(points_[0])).first;
    const auto [b, length2] = most(from(points_[a]));
    const double length = std::sqrt(length2);
    if (!(length > least)) return degenerate("coincide; their spread", length, "spread them");
    const Vec3 origin = points_[a], along = (points_[b] - origin) / length;
    const auto [c, width2] =
        most([&](const Vec3& p) { return along.cross(p - origin).squaredNorm(); });
    const double width = distance_to_segment(origin, points_[b], points_[c]);
    if (!(width2 > 0 && width > least)) {
      return degenerate("are collinear; their width", width, "give them width and thickness");
    }
    const Vec3 normal = triangle_shape(origin, points_[b], points_[c], good_normal_).normal;
    const auto [d, thickness] =
        most([&](const Vec3& p) { return std::fabs(normal.dot(p - origin)); });
    const int side = orientation(origin, points_[b], points_[c], points_[d]);
    if (!(thickness > least) || side == 0) {
      return degenerate("are flat; their thickness", thickness, "give them thickness");
    }

    std::array<uint32_t, 4> t{a, b, c, d};
    if (side > 0) std::swap(t[0], t[1]);
    // t[3] is now below the plane of t[0] t[1] t[2].
    next_.resize(points_.size());
    start_at_.resize(points_.size());
    faces_.resize(4);
    set_face(0, t[0], t[1], t[2]);
    set_face(1, t[1], t[0], t[3]);
    set_face(2, t[2], t[1], t[3]);
    set_face(3, t[0], t[2], t[3]);
    faces_[0].next = {1, 2, 3};
    faces_[1].next = {0, 3, 2};
    faces_[2].next = {0, 1, 3};
    faces_[3].next = {0, 2, 1};
    fresh_ = {0, 1, 2, 3};
    for (uint32_t p = 0; p < points_.size(); ++p) {
      if (p != a && p != b && p != c && p != d) assign(p);
    }
    for (uint32_t f : fresh_) enqueue(f, later_);
    return {};
  }

  /// Collects all faces that `p` is above, starting from one of them; they are connected.
  void find_visible(uint32_t from, uint32_t p) {
    ++mark_;
    visible_.assign(1, from);
    faces_[from].mark = mark_;
    for (size_t i = 0; i < visible_.size(); ++i) {
      for (uint32_t g : faces_[visible_[i]].next) {
        QuickhullFace& face = faces_[g];
        if (face.mark == mark_ || !is_above(face, p)) continue;
        face.mark = mark_;
        visible_.push_back(g);
      }
    }
  }

  struct HorizonSide {
    uint32_t a, b, beyond, side;  // edge from a to b; its side of the face beyond
  };

  void find_horizon() {
    horizon_.clear();
    for (uint32_t f : visible_) {
      const QuickhullFace& face = faces_[f];
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t g = face.next[k];
        if (faces_[g].mark == mark_) continue;
        const uint32_t b = face.v[(k + 1) % 3];
        const Triangle& w = faces_[g].v;
        const uint32_t side = w[0] == b ? 0 : w[1] == b ? 1 : 2;
        horizon_.push_back({face.v[k], b, g, side});
      }
    }
  }

  /// Replaces the visible faces by a fan from the horizon to `apex`, reusing their indices.
  void add_point(uint32_t apex) {
    find_horizon();
    orphans_.clear();
    for (uint32_t f : visible_) {
      if (faces_[f].first != no_index) orphans_.push_back(faces_[f].first);
      faces_[f].first = no_index;
    }
    fresh_.clear();
    free_.insert(free_.end(), visible_.rbegin(), visible_.rend());
    for (const HorizonSide& h : horizon_) {
      const uint32_t made = new_face();
      set_face(made, h.a, h.b, apex);
      faces_[made].next[0] = h.beyond;
      faces_[h.beyond].next[h.side] = made;
      start_at_[h.a] = made;
      fresh_.push_back(made);
    }
    for (uint32_t f : fresh_) {
      const uint32_t other = start_at_[faces_[f].v[1]];
      faces_[f].next[1] = other;
      faces_[other].next[2] = f;
    }
    for (uint32_t first : orphans_) {
      for (uint32_t p = first; p != no_index;) {
        const uint32_t after = next_[p];
        if (p != apex) assign(p);
        p = after;
      }
    }
    for (uint32_t f : fresh_) {
      if (faces_[f].first != no_index) enqueue(f, queue_);
    }
  }

  /// Points hardly or not above `from`, but away from its triangle: those farther than the
  /// tolerance from all faces that they see are added as vertices.
  void add_leftovers(uint32_t from) {
    while (faces_[from].first != no_index) {
      const uint32_t p = faces_[from].first;
      faces_[from].first = next_[p];
      find_visible(from, p);
      const bool near = std::any_of(visible_.begin(), visible_.end(), [&](uint32_t g) {
        const QuickhullFace& face = faces_[g];
        return distance(face, face.height(points_[p]), points_[p]) <= tolerance_;
      });
      if (!near) return add_point(p);
    }
  }

  std::vector<HullTriangle> collect() const {
    std::vector<uint32_t> number(faces_.size(), 0);
    for (uint32_t f : free_) number[f] = no_index;
    uint32_t count = 0;
    for (uint32_t& n : number) {
      if (n != no_index) n = count++;
    }
    std::vector<HullTriangle> out;
    out.reserve(count);
    for (size_t i = 0; i < faces_.size(); ++i) {
      const auto& [a, b, c] = faces_[i].next;
      if (number[i] != no_index) out.push_back({faces_[i].v, {number[a], number[b], number[c]}});
    }
    return out;
  }

  std::span<const Vec3> points_;
  double tolerance_;
  double extent_ = 0, good_normal_ = 0, threshold_ = 0;
  std::vector<QuickhullFace> faces_;
  std::vector<uint32_t> next_;  // next point in the list of the same face
  std::vector<uint32_t> free_;  // free face indices
  std::vector<uint32_t> queue_, later_;
  std::vector<uint32_t> visible_, fresh_, orphans_;
  std::vector<HorizonSide> horizon_;
  std::vector<uint32_t> start_at_;  // new face whose horizon side starts at a point
  uint32_t mark_ = 0;
};

}  // namespace

Result<std::vector<HullTriangle>> quickhull(std::span<const Vec3> points, double tolerance) {
  return Quickhull(points, tolerance).run();
}

}  // namespace tumble
