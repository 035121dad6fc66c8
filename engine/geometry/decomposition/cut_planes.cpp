#include "engine/geometry/decomposition/cut_planes.hpp"

#include "engine/geometry/decomposition/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble {
namespace {

constexpr size_t most_notches_tried = 400;  ///< of a solid: their planes suffice as candidates
constexpr size_t most_groups = 3;     ///< planes through each notch that contain other notches too
constexpr size_t most_measured = 24;  ///< best planes whose sections are compared

struct Candidate {
  CutPlane cut;
  int gained = 0;      ///< notches resolved minus notches cut in two
  double section = 0;  ///< length of its outline [m]
};

class Chooser {
 public:
  Chooser(const ExactSpace& space, const SolidPiece& piece, std::span<const Notch> notches,
          std::span<const ReflexEdge> edges, double tolerance)
      : space_(space), piece_(piece), notches_(notches), edges_(edges), tolerance_(tolerance) {
    for (const Notch& n : notches) ends_.push_back({at(n.points[0]), at(n.points[1])});
  }

  std::vector<CutPlane> choose() {
    const size_t stride = notches_.size() / most_notches_tried + 1;
    for (size_t n = 0; n < notches_.size(); n += stride) offer_planes_of(notches_[n]);
    std::stable_sort(found_.begin(), found_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.gained > b.gained; });
    const size_t measured = std::min(found_.size(), most_measured);
    for (size_t i = 0; i < measured; ++i) found_[i].section = outline(found_[i].cut.near);
    std::stable_sort(found_.begin(), found_.begin() + std::ptrdiff_t(measured),
                     [](const Candidate& a, const Candidate& b) {
                       return a.gained != b.gained ? a.gained > b.gained : a.section < b.section;
                     });
    std::vector<CutPlane> out;
    for (const Candidate& c : found_) out.push_back(c.cut);
    return out;
  }

 private:
  const Vec3& at(uint32_t point) const { return space_.at(point); }

  void offer_planes_of(const Notch& notch) {
    const ReflexEdge& edge = edges_[notch.edge];
    for (const uint32_t plane : edge.planes) offer({space_.plane(plane), space_.through(plane)});
    const Vec3 &a = at(edge.corners[0]), &b = at(edge.corners[1]);
    const Vec3 across = space_.plane(edge.planes[0]).normal - space_.plane(edge.planes[1]).normal;
    offer_through(a, b, a + across.cross(b - a) / std::max(across.norm(), tolerances::same_turn));
    offer_groups(a, b);
  }

  /// Planes through a notch that contain other notches; those with the most first.
  void offer_groups(const Vec3& a, const Vec3& b) {
    const Vec3 u = (b - a).normalized();
    const Vec3 v = u.unitOrthogonal(), w = u.cross(v);
    turns_.clear();
    for (size_t n = 0; n < notches_.size(); ++n) {
      const Vec3 p = ends_[n][0] - a, q = ends_[n][1] - a;
      const Vec2 fp(p.dot(v), p.dot(w)), fq(q.dot(v), q.dot(w));
      const Vec2& far = fp.squaredNorm() > fq.squaredNorm() ? fp : fq;
      const double size = far.norm();
      if (size <= tolerance_) continue;  // on the line of the notch
      const Vec2 across(-far.y() / size, far.x() / size);
      if (std::fabs(across.dot(fp)) > tolerance_ || std::fabs(across.dot(fq)) > tolerance_)
        continue;
      double turn = std::atan2(far.y(), far.x());
      if (turn < 0) turn += std::numbers::pi;
      if (turn > std::numbers::pi - tolerances::same_turn) turn = 0;
      turns_.push_back({turn, notches_[n].edge});
    }
    std::sort(turns_.begin(), turns_.end());
    std::vector<std::pair<int, uint32_t>> groups;  // negative size, and edge of the first notch
    for (size_t first = 0; first < turns_.size();) {
      size_t end = first + 1;
      while (end < turns_.size() &&
             turns_[end].first - turns_[end - 1].first < tolerances::same_turn)
        ++end;
      groups.emplace_back(-int(end - first), turns_[first].second);
      first = end;
    }
    std::sort(groups.begin(), groups.end());
    for (size_t g = 0; g < std::min(groups.size(), most_groups); ++g) {
      const ReflexEdge& other = edges_[groups[g].second];
      const Vec3 &p = at(other.corners[0]), &q = at(other.corners[1]);
      const bool first = u.cross(p - a).squaredNorm() > u.cross(q - a).squaredNorm();
      offer_through(a, b, first ? p : q);
    }
  }

  void offer_through(const Vec3& a, const Vec3& b, const Vec3& c) {
    if (const auto plane = plane_through(a, b, c)) offer({*plane, {a, b, c}});
  }

  void offer(const CutPlane& cut) {
    Candidate c{cut, 0, 0};
    const Plane& plane = cut.near;
    for (const auto& [start, end] : ends_) {
      const double p = plane.distance(start), q = plane.distance(end);
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
    for (const SolidPiece::Face& f : piece_.faces) {
      std::array<Vec3, 2> met;
      size_t count = 0;
      for (const uint32_t s : f.sides) {
        const Vec3 &a = at(piece_.sides[s].start), &b = at(piece_.sides[s].end);
        const double from = plane.distance(a), to = plane.distance(b);
        if ((from > 0) != (to > 0) && count < 2) met[count++] = a + from / (from - to) * (b - a);
      }
      if (count == 2) out += (met[0] - met[1]).norm();
    }
    return out;
  }

  const ExactSpace& space_;
  const SolidPiece& piece_;
  std::span<const Notch> notches_;
  std::span<const ReflexEdge> edges_;
  std::vector<std::array<Vec3, 2>> ends_;  ///< of the notches
  double tolerance_;
  std::vector<std::pair<double, uint32_t>> turns_;  ///< angle and edge
  std::vector<Candidate> found_;
};

}  // namespace

std::vector<CutPlane> cut_planes(const ExactSpace& space, const SolidPiece& piece,
                                 std::span<const Notch> notches, std::span<const ReflexEdge> edges,
                                 double tolerance) {
  return Chooser(space, piece, notches, edges, tolerance).choose();
}

}  // namespace tumble
