#include "engine/geometry/hull/quickhull.hpp"

#include "engine/geometry/predicates/orientation.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

// Quickhull with exact visibility. Because "above" is decided exactly, the faces that a point sees
// always form a disc with a simple horizon, every new triangle has area, and the surface stays a
// closed convex one for any input. Distances are only used to choose the next point.
namespace tumble {
namespace {

constexpr double unit = 1.1102230246251565e-16;

struct Face {
  Triangle v;
  std::array<uint32_t, 3> next;  // neighbour across side k
  Vec3 normal;
  double uncertainty;           // of height() [m]
  std::vector<uint32_t> above;  // points strictly above, each in the list of one face only
  double highest = 0;
  uint32_t apex = no_index;
  bool alive = true;
  uint32_t mark = 0;
};

class Quickhull {
 public:
  Quickhull(std::span<const Vec3> points, double tolerance)
      : points_(points), tolerance_(tolerance), start_at_(points.size(), no_index) {
    Aabb box;
    for (const Vec3& p : points) box.include(p);
    extent_ = box.extent().norm();
  }

  Result<std::vector<HullTriangle>> run() {
    if (Status ok = start(); !ok) return ok.error();
    do {
      while (!queue_.empty()) {
        const uint32_t f = queue_.back();
        queue_.pop_back();
        if (faces_[f].alive && faces_[f].highest > tolerance_) add_point(f);
      }
    } while (requeue_leftovers());
    return collect();
  }

 private:
  double height(const Face& f, uint32_t p) const {
    return f.normal.dot(points_[p] - points_[f.v[0]]);
  }

  bool is_above(const Face& f, uint32_t p, double& h) const {
    h = height(f, p);
    if (h > f.uncertainty) return true;
    if (h < -f.uncertainty) return false;
    return orientation(points_[f.v[0]], points_[f.v[1]], points_[f.v[2]], points_[p]) > 0;
  }

  uint32_t make_face(uint32_t a, uint32_t b, uint32_t c) {
    Face f;
    f.v = {a, b, c};
    f.next = {no_index, no_index, no_index};
    const Vec3 u = points_[b] - points_[a], w = points_[c] - points_[a];
    const Vec3 n = u.cross(w);
    const double area = n.norm();
    f.normal = area > 0 ? Vec3(n / area) : Vec3(Vec3::Zero());
    const double longest = std::max({u.squaredNorm(), w.squaredNorm(), (u - w).squaredNorm()});
    f.uncertainty = area > 0 ? 128 * unit * extent_ * (longest / area + 2)
                             : std::numeric_limits<double>::infinity();
    faces_.push_back(std::move(f));
    return uint32_t(faces_.size() - 1);
  }

  /// Puts `p` into the list of the first of `candidates` that it is above.
  bool assign(uint32_t p, std::span<const uint32_t> candidates) {
    for (uint32_t f : candidates) {
      double h;
      if (is_above(faces_[f], p, h)) {
        hang(f, p, h);
        return true;
      }
    }
    return false;
  }

  void hang(uint32_t f, uint32_t p, double h) {
    Face& face = faces_[f];
    face.above.push_back(p);
    if (face.apex == no_index || h > face.highest) {
      face.highest = h;
      face.apex = p;
    }
  }

  Status start() {
    const auto degenerate = [&](const char* shape, const char* cure) {
      return Error{
          ErrorCode::invalid_argument,
          fmt::format("the {} points {} within {:.3g} m", points_.size(), shape, 4 * tolerance_),
          {},
          cure};
    };
    const auto furthest = [&](const auto& measure) {
      uint32_t best = 0;
      double most = -1;
      for (uint32_t p = 0; p < points_.size(); ++p) {
        const double m = measure(points_[p]);
        if (m > most) {
          most = m;
          best = p;
        }
      }
      return std::pair(best, most);
    };
    const uint32_t a = furthest([&](const Vec3& p) { return (p - points_[0]).norm(); }).first;
    const auto [b, length] = furthest([&](const Vec3& p) { return (p - points_[a]).norm(); });
    if (!(length > 4 * tolerance_)) return degenerate("coincide", "spread them");
    const Vec3 along = (points_[b] - points_[a]) / length;
    const auto [c, width] =
        furthest([&](const Vec3& p) { return along.cross(p - points_[a]).norm(); });
    if (!(width > 4 * tolerance_)) return degenerate("are collinear", "give them volume");
    const Vec3 normal = along.cross(points_[c] - points_[a]).normalized();
    const auto [d, thickness] =
        furthest([&](const Vec3& p) { return std::fabs(normal.dot(p - points_[a])); });
    if (!(thickness > 4 * tolerance_)) return degenerate("are flat, thickness 0", "thicken them");

    std::array<uint32_t, 4> t{a, b, c, d};
    if (orientation(points_[a], points_[b], points_[c], points_[d]) > 0) std::swap(t[0], t[1]);
    // d is below a b c.
    for (const Triangle& v : {Triangle{t[0], t[1], t[2]}, Triangle{t[1], t[0], t[3]},
                              Triangle{t[2], t[1], t[3]}, Triangle{t[0], t[2], t[3]}}) {
      make_face(v[0], v[1], v[2]);
    }
    faces_[0].next = {1, 2, 3};
    faces_[1].next = {0, 3, 2};
    faces_[2].next = {0, 1, 3};
    faces_[3].next = {0, 2, 1};
    const std::array<uint32_t, 4> all{0, 1, 2, 3};
    for (uint32_t p = 0; p < points_.size(); ++p) assign(p, all);
    for (uint32_t f : all) {
      if (faces_[f].apex != no_index) queue_.push_back(f);
    }
    return {};
  }

  /// Marks every face that sees `p`, from one that does; they are connected.
  void find_visible(uint32_t from, uint32_t p) {
    ++mark_;
    visible_.assign(1, from);
    faces_[from].mark = mark_;
    for (size_t i = 0; i < visible_.size(); ++i) {
      for (uint32_t g : faces_[visible_[i]].next) {
        double h;
        if (faces_[g].mark == mark_ || !is_above(faces_[g], p, h)) continue;
        faces_[g].mark = mark_;
        visible_.push_back(g);
      }
    }
  }

  void add_point(uint32_t from) {
    const uint32_t apex = faces_[from].apex;
    find_visible(from, apex);
    fresh_.clear();
    for (size_t i = 0; i < visible_.size(); ++i) {
      for (size_t k = 0; k < 3; ++k) {
        const Face& f = faces_[visible_[i]];
        const uint32_t beyond = f.next[k];
        if (faces_[beyond].mark == mark_) continue;
        const uint32_t a = f.v[k], b = f.v[(k + 1) % 3];
        const uint32_t made = make_face(a, b, apex);
        faces_[made].next[0] = beyond;
        Face& g = faces_[beyond];
        for (size_t j = 0; j < 3; ++j) {
          if (g.v[j] == b && g.v[(j + 1) % 3] == a) g.next[j] = made;
        }
        start_at_[a] = made;
        fresh_.push_back(made);
      }
    }
    for (uint32_t f : fresh_) {
      const uint32_t other = start_at_[faces_[f].v[1]];
      faces_[f].next[1] = other;
      faces_[other].next[2] = f;
    }
    for (uint32_t f : visible_) {
      faces_[f].alive = false;
      const std::vector<uint32_t> orphans = std::move(faces_[f].above);
      faces_[f].above = {};
      for (uint32_t p : orphans) {
        if (p != apex) assign(p, fresh_);
      }
    }
    for (uint32_t f : fresh_) {
      if (faces_[f].apex != no_index) queue_.push_back(f);
    }
  }

  /// A point may be barely above the face in whose list it is, yet well above another one.
  bool requeue_leftovers() {
    bool again = false;
    const size_t count = faces_.size();
    for (uint32_t f = 0; f < count; ++f) {
      if (!faces_[f].alive || faces_[f].above.empty()) continue;
      const std::vector<uint32_t> points = std::move(faces_[f].above);
      faces_[f].above = {};
      faces_[f].apex = no_index;
      faces_[f].highest = 0;
      for (uint32_t p : points) {
        find_visible(f, p);
        uint32_t best = f;
        double most = tolerance_;
        for (uint32_t g : visible_) {
          const double h = height(faces_[g], p);
          if (h > most) {
            most = h;
            best = g;
          }
        }
        if (most <= tolerance_) continue;  // near enough to leave out
        hang(best, p, most);
        queue_.push_back(best);
        again = true;
      }
    }
    return again;
  }

  std::vector<HullTriangle> collect() const {
    std::vector<uint32_t> number(faces_.size(), no_index);
    uint32_t count = 0;
    for (size_t f = 0; f < faces_.size(); ++f) {
      if (faces_[f].alive) number[f] = count++;
    }
    std::vector<HullTriangle> out;
    out.reserve(count);
    for (const Face& f : faces_) {
      if (f.alive) out.push_back({f.v, {number[f.next[0]], number[f.next[1]], number[f.next[2]]}});
    }
    return out;
  }

  std::span<const Vec3> points_;
  double tolerance_;
  double extent_ = 0;
  std::vector<Face> faces_;
  std::vector<uint32_t> queue_, visible_, fresh_;
  std::vector<uint32_t> start_at_;  // the new face whose horizon side starts at a point
  uint32_t mark_ = 0;
};

}  // namespace

Result<std::vector<HullTriangle>> quickhull(std::span<const Vec3> points, double tolerance) {
  return Quickhull(points, tolerance).run();
}

}  // namespace tumble
