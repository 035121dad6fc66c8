#include "engine/collision/gjk/epa.hpp"

#include "engine/collision/gjk/polytope.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Difference of the bounds at which the search ends, in units of the scale.
constexpr double depth_met = 2e-13;
/// Differences thinner than this count as flat, in units of the scale.
constexpr double flat = 1e-13;

double length(const Plain3& p) {
  return std::sqrt(p.squared());
}

class Expansion3 {
 public:
  Expansion3(const PlacedCore& A, const PlacedCore& B, EpaTrace* trace)
      : difference_(A, B), scale_(difference_.scale()), trace_(trace) {}

  EpaResult run(const Simplex& start, double relative_tolerance);

 private:
  DifferencePoint probe(const Plain3& n);
  bool blow_up(const Simplex& s, std::array<DifferencePoint, 4>& corners);
  void expand(EpaResult& r, double relative_tolerance);
  void witness(int face, EpaResult& r) const;
  EpaStage stage(int nearest, const DifferencePoint& p) const;

  Difference difference_;
  double scale_;
  EpaTrace* trace_;
  Polytope polytope_;
  Plain3 best_normal_{0, 1, 0};
  double best_depth_ = std::numeric_limits<double>::infinity();
};

/// Support along unit n; the least height found so far is the depth of the result.
DifferencePoint Expansion3::probe(const Plain3& n) {
  const DifferencePoint p = difference_.support(n);
  const double height = n.dot(p.w);
  if (height < best_depth_) best_depth_ = height, best_normal_ = n;
  return p;
}

/// Four corners with volume, from gjk()'s simplex and supports perpendicular to it. False if the
/// difference is flat; the depth is then the least height of the supports.
bool Expansion3::blow_up(const Simplex& s, std::array<DifferencePoint, 4>& c) {
  size_t count = size_t(s.count);
  std::copy_n(s.points.begin(), count, c.begin());
  const double least = flat * scale_;
  if (count == 1) {
    for (int k = 0; k < 6 && count == 1; ++k) {
      c[1] = probe(Plain3::of((k % 2 ? -1.0 : 1.0) * Vec3::Unit(k / 2)));
      if (length(c[1].w - c[0].w) > least) count = 2;
    }
    if (count == 1) return false;
  }
  if (count == 2) {
    const Vec3 d = (c[1].w - c[0].w).vec().normalized();
    Vec3 t1, t2;
    tangent_frame(d, t1, t2);
    for (const Vec3& n : {t1, Vec3(-t1), t2, Vec3(-t2)}) {
      c[2] = probe(Plain3::of(n));
      const Vec3 off = (c[2].w - c[0].w).vec();
      if ((off - d * d.dot(off)).norm() <= least) continue;
      count = 3;
      break;
    }
    if (count == 2) return false;
  }
  if (count == 3) {
    Plain3 n = (c[1].w - c[0].w).cross(c[2].w - c[0].w);
    const double area = length(n);
    if (!(area > 0)) return false;
    n = n * (1 / area);
    const DifferencePoint up = probe(n), down = probe(-n);
    const double above = n.dot(up.w - c[0].w), below = -n.dot(down.w - c[0].w);
    if (std::max(above, below) <= least) return false;
    c[3] = above >= below ? up : down;
  }
  return true;
}

/// Computes the points of A and B whose difference is the point of the face nearest to the origin.
void Expansion3::witness(int face, EpaResult& r) const {
  Simplex s;
  for (int c : polytope_.face(face).corner) s.add(polytope_.vertex(c));
  NearestPoint near;
  if (reduce_from_all_sides(s, near) == Reduction::outside)
    set_weights(s, near.v, depth_met * scale_);
  r.a = difference_.point_out(s.nearest_a());
  r.b = difference_.point_out(s.nearest_b());
}

EpaStage Expansion3::stage(int nearest, const DifferencePoint& p) const {
  EpaStage s;
  for (int f = 0; f < polytope_.face_slots(); ++f) {
    const Polytope::Face& face = polytope_.face(f);
    if (!face.alive) continue;
    if (f == nearest) s.nearest = s.faces.size();
    const auto corner = [&](size_t k) { return polytope_.vertex(face.corner[k]).w.vec(); };
    s.faces.push_back({corner(0), corner(1), corner(2)});
  }
  s.normal = polytope_.face(nearest).normal.vec();
  s.support = p.w.vec();
  s.lower = std::max(0.0, std::min(polytope_.offset(nearest), best_depth_));
  s.upper = best_depth_;
  return s;
}

void Expansion3::expand(EpaResult& r, double relative_tolerance) {
  const double allowed = difference_.always_polyhedral() ? 0 : relative_tolerance;
  for (r.iterations = 1;; ++r.iterations) {
    const int nearest = polytope_.nearest_face();
    const double offset = polytope_.offset(nearest);
    if (!std::isfinite(offset)) break;
    r.lower_bound = std::max(0.0, std::min(offset, best_depth_));
    const Plain3 n = polytope_.face(nearest).normal;
    const DifferencePoint p = probe(n);
    if (trace_) trace_->push_back(stage(nearest, p));
    const double beyond = n.dot(p.w) - offset;
    const double enough = depth_met * scale_ + allowed * best_depth_;
    if (beyond <= enough || best_depth_ - offset <= enough) {
      r.converged = best_depth_ - offset <= enough;
      witness(nearest, r);
      return;
    }
    if (!polytope_.add(p, nearest)) {
      witness(nearest, r);
      return;
    }
  }
}

EpaResult Expansion3::run(const Simplex& start, double relative_tolerance) {
  EpaResult r;
  r.a = difference_.point_out(start.nearest_a());
  r.b = difference_.point_out(start.nearest_b());
  std::array<DifferencePoint, 4> corners;
  if (blow_up(start, corners) && polytope_.start(corners))
    expand(r, relative_tolerance);
  else
    r.converged = true;
  r.normal = difference_.direction_out(best_normal_);
  r.depth = std::isfinite(best_depth_) ? std::max(best_depth_, 0.0) : 0;
  return r;
}

}  // namespace

EpaResult epa(const PlacedCore& A, const PlacedCore& B, const Simplex& start,
              double relative_tolerance, EpaTrace* trace) {
  return Expansion3(A, B, trace).run(start, relative_tolerance);
}

}  // namespace tumble
