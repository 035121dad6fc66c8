#include "engine/geometry/decomposition/cut_planes.hpp"

#include "engine/geometry/decomposition/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble {
namespace {

constexpr size_t most_notches_tried = 400;  ///< of a solid: their planes are enough to choose from
constexpr size_t most_groups = 3;           ///< planes through each notch and others
constexpr size_t most_measured = 24;        ///< best planes whose sections are compared

struct Candidate {
  Plane plane;
  int gained = 0;      ///< notches resolved less those cut in two
  double section = 0;  ///< length of its outline [m]
};

class Chooser {
 public:
  Chooser(const SolidPiece& piece, std::span<const Notch> notches, std::span<const Plane> planes,
          double tolerance)
      : piece_(piece), notches_(notches), planes_(planes), tolerance_(tolerance) {}

  std::vector<Plane> choose() {
    const size_t stride = notches_.size() / most_notches_tried + 1;
    for (size_t n = 0; n < notches_.size(); n += stride) offer_planes_of(notches_[n]);
    std::stable_sort(found_.begin(), found_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.gained > b.gained; });
    const size_t measured = std::min(found_.size(), most_measured);
    for (size_t i = 0; i < measured; ++i) found_[i].section = outline(found_[i].plane);
    std::stable_sort(found_.begin(), found_.begin() + std::ptrdiff_t(measured),
                     [](const Candidate& a, const Candidate& b) {
                       return a.gained != b.gained ? a.gained > b.gained : a.section < b.section;
                     });
    std::vector<Plane> out;
    for (const Candidate& c : found_) out.push_back(c.plane);
    return out;
  }

 private:
  const Vec3& at(uint32_t v) const { return piece_.mesh.vertices[v]; }

  void offer_planes_of(const Notch& notch) {
    const Vec3 a = at(notch.vertices[0]), b = at(notch.vertices[1]);
    const Vec3 u = (b - a).normalized(), middle = (a + b) / 2;
    const Plane &first = planes_[notch.planes[0]], &second = planes_[notch.planes[1]];
    offer(first);
    offer(second);
    offer_through(middle, first.normal - second.normal);
    offer_groups(a, u, middle);
  }

  /// Planes about the notch that hold other notches, those with the most first.
  void offer_groups(const Vec3& a, const Vec3& u, const Vec3& middle) {
    const Vec3 v = u.unitOrthogonal(), w = u.cross(v);
    turns_.clear();
    for (const Notch& other : notches_) {
      const Vec3 p = at(other.vertices[0]) - a, q = at(other.vertices[1]) - a;
      const Vec2 fp(p.dot(v), p.dot(w)), fq(q.dot(v), q.dot(w));
      const Vec2& far = fp.squaredNorm() > fq.squaredNorm() ? fp : fq;
      const double size = far.norm();
      if (size <= tolerance_) continue;  // on the same line
      const Vec2 across(-far.y() / size, far.x() / size);
      if (std::fabs(across.dot(fp)) > tolerance_ || std::fabs(across.dot(fq)) > tolerance_)
        continue;
      double turn = std::atan2(far.y(), far.x());
      if (turn < 0) turn += std::numbers::pi;
      if (turn > std::numbers::pi - tolerances::same_turn) turn = 0;
      turns_.push_back(turn);
    }
    std::sort(turns_.begin(), turns_.end());
    std::vector<std::pair<int, double>> groups;
    for (size_t first = 0; first < turns_.size();) {
      size_t end = first + 1;
      while (end < turns_.size() && turns_[end] - turns_[end - 1] < tolerances::same_turn) ++end;
      groups.emplace_back(-int(end - first), turns_[first]);
      first = end;
    }
    std::sort(groups.begin(), groups.end());
    for (size_t g = 0; g < std::min(groups.size(), most_groups); ++g) {
      const double turn = groups[g].second;
      offer_through(middle, -std::sin(turn) * v + std::cos(turn) * w);
    }
  }

  void offer_through(const Vec3& point, const Vec3& normal) {
    const double length = normal.norm();
    if (length > tolerances::same_turn) {
      const Vec3 n = normal / length;
      offer({n, n.dot(point)});
    }
  }

  void offer(const Plane& plane) {
    Candidate c{plane, 0, 0};
    for (const Notch& n : notches_) {
      const double p = plane.distance(at(n.vertices[0])), q = plane.distance(at(n.vertices[1]));
      const bool p_on = std::fabs(p) <= tolerance_, q_on = std::fabs(q) <= tolerance_;
      if (p_on && q_on) {
        ++c.gained;
      } else if (!p_on && !q_on && (p > 0) != (q > 0)) {
        --c.gained;
      }
    }
    found_.push_back(c);
  }

  double outline(const Plane& plane) const {
    double out = 0;
    for (const Triangle& t : piece_.mesh.triangles) {
      std::array<double, 3> h;
      for (size_t k = 0; k < 3; ++k) h[k] = plane.distance(at(t[k]));
      std::array<Vec3, 3> met;
      size_t count = 0;
      for (size_t k = 0; k < 3; ++k) {
        const size_t next = (k + 1) % 3;
        if ((h[k] > 0) != (h[next] > 0))
          met[count++] = at(t[k]) + h[k] / (h[k] - h[next]) * (at(t[next]) - at(t[k]));
      }
      if (count == 2) out += (met[0] - met[1]).norm();
    }
    return out;
  }

  const SolidPiece& piece_;
  std::span<const Notch> notches_;
  std::span<const Plane> planes_;
  double tolerance_;
  std::vector<double> turns_;
  std::vector<Candidate> found_;
};

}  // namespace

std::vector<Plane> cut_planes(const SolidPiece& piece, std::span<const Notch> notches,
                              std::span<const Plane> planes, double tolerance) {
  return Chooser(piece, notches, planes, tolerance).choose();
}

std::vector<std::array<uint32_t, 2>> notches_on(const Plane& plane, const SolidPiece& piece,
                                                std::span<const Notch> notches, double tolerance) {
  std::vector<std::array<uint32_t, 2>> out;
  for (const Notch& n : notches)
    if (std::fabs(plane.distance(piece.mesh.vertices[n.vertices[0]])) <= tolerance &&
        std::fabs(plane.distance(piece.mesh.vertices[n.vertices[1]])) <= tolerance)
      out.push_back(n.vertices);
  return out;
}

}  // namespace tumble
