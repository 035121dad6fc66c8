#include "engine/geometry/wrap/fit_wrap.hpp"

#include "engine/core/crew.hpp"
#include "engine/core/stop.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"
#include "engine/geometry/wrap/changing_tree.hpp"
#include "engine/geometry/wrap/surface_clash.hpp"
#include "engine/geometry/wrap/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace tumble {
namespace {

/// f(i) for all i, in any order.
template <class F>
void for_each(Crew* crew, size_t n, const F& f) {
  const auto unless_stopped = [&](size_t i) {
    if (!stop_requested()) f(i);
  };
  if (crew) {
    crew->each(n, unless_stopped);
  } else {
    for (size_t i = 0; i < n; ++i) unless_stopped(i);
  }
}

/// Where a piece of the surface should be: n . x = at.
struct WantedPlane {
  Vec3 n = Vec3::Zero();
  double at = 0;
  double weight = 0;  ///< area [m^2]
};

class Fitting {
 public:
  Fitting(TriangleMesh& wrap, const EnclosedMesh& mesh, const WrapFit& fit)
      : wrap_(wrap), mesh_(mesh), fit_(fit), tree_(wrap) {}

  /// False when no vertex moved by what matters.
  bool pass();
  /// After the passes: those that the others' ways kept behind go alone.
  void bring_left_behind();

 private:
  bool plane_before(const Vec3& x, double reach, WantedPlane& plane) const;
  void want_planes();
  void set_goals(bool first);
  /// Halves the ways of the vertices of a triangle; false if there is nothing left to halve.
  bool shorten(uint32_t triangle);
  void place(uint32_t v) {
    wrap_.vertices[v] = from_[v] + std::ldexp(1.0, -halved_[v]) * (goal_[v] - from_[v]);
    if (halved_[v] > tolerances::most_halvings) wrap_.vertices[v] = from_[v];
  }
  template <class F>
  void each_met(uint32_t triangle, const F& f) const;
  bool free(uint32_t triangle) const;
  void free_triangles();
  bool free_witnesses();
  void place_changed();
  void gather_stars();
  std::span<const uint32_t> star(uint32_t v) const {
    return {stars_.data() + first_of_star_[v], first_of_star_[v + 1] - first_of_star_[v]};
  }
  double height(const Vec3& x) const;
  bool bring(uint32_t v);
  bool move_alone(uint32_t v, const Vec3& to);

  TriangleMesh& wrap_;
  const EnclosedMesh& mesh_;
  const WrapFit& fit_;
  ChangingTree tree_;  ///< of the wrap as it is
  std::vector<WantedPlane> planes_;
  std::vector<uint8_t> closes_gap_;  ///< triangles that follow no mesh, as the first pass found
  std::vector<Vec3> from_, goal_;
  std::vector<int8_t> halved_;
  std::vector<uint8_t> shortened_;               ///< vertices whose way was halved in this round
  std::vector<uint8_t> untested_;                ///< triangles
  std::vector<uint32_t> first_of_star_, stars_;  ///< triangles about each vertex
  std::vector<uint32_t> near_witnesses_;
};

/// The plane at the offset before the point of the mesh nearest to x; false beyond `reach`.
bool Fitting::plane_before(const Vec3& x, double reach, WantedPlane& plane) const {
  const auto near = mesh_.mesh().closest(x, reach);
  if (!near || !(near->squared_distance > 0)) return false;
  plane.n = (x - near->point) / std::sqrt(near->squared_distance);
  plane.at = plane.n.dot(near->point) + fit_.offset;
  return true;
}

void Fitting::want_planes() {
  const bool first = planes_.empty();
  planes_.resize(wrap_.triangles.size());
  closes_gap_.resize(planes_.size(), 0);
  const double follows = first ? fit_.stand + tolerances::follows_within * fit_.cell
                               : std::numeric_limits<double>::infinity();
  for_each(fit_.crew, planes_.size(), [&](size_t t) {
    if (closes_gap_[t]) return;
    const Vec3 middle = (wrap_.corner(t, 0) + wrap_.corner(t, 1) + wrap_.corner(t, 2)) / 3;
    const Vec3 area = face_area_vector(wrap_, t);
    WantedPlane& plane = planes_[t];
    plane.weight = area.norm();
    if (!(plane.weight > 0) || plane_before(middle, follows, plane)) return;
    closes_gap_[t] = 1;
    plane.n = area / plane.weight;
    plane.at = std::numeric_limits<double>::infinity();  // no vertex is above it
  });
}

void Fitting::set_goals(bool first) {
  const size_t count = wrap_.vertices.size();
  // Alone a vertex goes to the offset before the nearest point. Where it closes a gap it goes to
  // the mean of the triangles about it, which smooths what the grid left rough, and inwards with
  // them.
  std::vector<WantedPlane> own(count);
  std::vector<Vec3> mean(count, Vec3::Zero());
  std::vector<uint8_t> follows(count, 1);
  for (size_t t = 0; t < planes_.size(); ++t)
    for (const uint32_t v : wrap_.triangles[t]) {
      const WantedPlane& p = planes_[t];
      own[v].weight += p.weight;
      const Vec3 middle =
          (wrap_.corner(t, 0) + wrap_.corner(t, 1) + wrap_.corner(t, 2)) / 3 - wrap_.vertices[v];
      mean[v] += p.weight * (middle - (first ? fit_.stand - fit_.offset : 0) * p.n);
      if (closes_gap_[t]) follows[v] = 0;
    }
  for_each(fit_.crew, count, [&](size_t v) {
    const Vec3& x = wrap_.vertices[v];
    if (follows[v] && plane_before(x, std::numeric_limits<double>::infinity(), own[v])) {
      goal_[v] = x + (own[v].at - own[v].n.dot(x)) * own[v].n;
    } else if (own[v].weight > 0) {
      goal_[v] = x + mean[v] / own[v].weight;
    }
  });
  if (first) return;
  // There it may be above the planes of its triangles, in a valley: then it goes down to where they
  // meet. Over a ridge it is below them and stays, so that the order of vertices about it does.
  std::vector<Mat3> sum(count, Mat3::Zero());
  std::vector<Vec3> side(count, Vec3::Zero());
  for (size_t t = 0; t < planes_.size(); ++t)
    for (const uint32_t v : wrap_.triangles[t]) {
      const WantedPlane& p = planes_[t];
      const double way = p.at - p.n.dot(goal_[v]);
      if (!(way < -tolerances::above_plane * fit_.cell)) continue;
      sum[v] += p.weight * (p.n * p.n.transpose());
      side[v] += p.weight * way * p.n;
    }
  for_each(fit_.crew, count, [&](size_t v) {
    if (side[v].isZero(0)) return;
    const WantedPlane& o = own[v];
    const Mat3 all = sum[v] + o.weight * (o.n * o.n.transpose()) +
                     tolerances::alone_weight * o.weight * Mat3::Identity();
    const Vec3 step = all.inverse() * side[v];
    const double length = step.norm(), most = tolerances::longest_way * fit_.stand;
    goal_[v] += length > most ? Vec3(step * (most / length)) : step;
  });
}

bool Fitting::shorten(uint32_t triangle) {
  bool any = false;
  for (const uint32_t v : wrap_.triangles[triangle]) {
    if (shortened_[v]) any = true;
    if (shortened_[v] || halved_[v] > tolerances::most_halvings) continue;
    ++halved_[v];
    shortened_[v] = 1;
    any = true;
  }
  return any;
}

void Fitting::place_changed() {
  for (uint32_t v = 0; v < shortened_.size(); ++v)
    if (shortened_[v]) place(v);
  for (uint32_t t = 0; t < wrap_.triangles.size(); ++t) {
    const Triangle& id = wrap_.triangles[t];
    if (!shortened_[id[0]] && !shortened_[id[1]] && !shortened_[id[2]]) continue;
    untested_[t] = 1;
    tree_.set(t, triangle_bounds(wrap_, t));
  }
  std::fill(shortened_.begin(), shortened_.end(), uint8_t{0});
}

/// Calls f(other) for the triangles that one meets beyond what they share, while f gives true.
template <class F>
void Fitting::each_met(uint32_t triangle, const F& f) const {
  const NumberedTriangle own{wrap_.triangles[triangle], corners(wrap_, triangle)};
  bool on = true;
  tree_.each(triangle_bounds(wrap_, triangle), [&](uint32_t other) {
    if (on && other != triangle && clash(own, {wrap_.triangles[other], corners(wrap_, other)}))
      on = f(other);
  });
}

/// A triangle keeps clear of the mesh and meets no other.
bool Fitting::free(uint32_t triangle) const {
  bool met = false;
  each_met(triangle, [&](uint32_t) { return !(met = true); });
  return !met && mesh_.clear_of(corners(wrap_, triangle));
}

/// Until every triangle is free. Of two that meet one was changed and is tested; both must yield,
/// as that one may have nothing left to yield.
void Fitting::free_triangles() {
  std::vector<uint8_t> bad(wrap_.triangles.size());
  for (bool again = true; again && !stop_requested();) {
    for_each(fit_.crew, bad.size(), [&](size_t t) {
      bad[t] = untested_[t] && !free(uint32_t(t));
      untested_[t] = 0;
    });
    again = false;
    for (uint32_t t = 0; t < bad.size(); ++t) {
      if (!bad[t]) continue;
      again = shorten(t) || again;
      each_met(t, [&](uint32_t other) {
        again = shorten(other) || again;
        return true;
      });
    }
    place_changed();
  }
}

/// Shortens the ways of triangles that passed over a witness; whether there were any.
bool Fitting::free_witnesses() {
  const AabbTree tree(std::make_shared<const TriangleMesh>(wrap_));
  std::vector<Vec3> lost;
  for (const Vec3& p : mesh_.witnesses()) {
    if (stop_requested()) return false;
    if (point_in_object(p, tree).side != PointSide::inside) lost.push_back(p);
  }
  bool any = false;
  for (uint32_t t = 0; t < wrap_.triangles.size() && !lost.empty(); ++t) {
    Aabb swept;
    for (const uint32_t v : wrap_.triangles[t])
      swept.include(wrap_.vertices[v]), swept.include(from_[v]);
    for (const Vec3& p : lost)
      if (swept.contains(p)) any = shorten(t) || any;
  }
  place_changed();
  return any;
}

bool Fitting::pass() {
  const bool first = planes_.empty();
  want_planes();
  if (stop_requested()) return false;
  from_ = goal_ = wrap_.vertices;
  set_goals(first);
  if (stop_requested()) return false;
  halved_.assign(from_.size(), 0);
  untested_.assign(wrap_.triangles.size(), 1);
  shortened_.assign(from_.size(), 1);
  place_changed();
  do free_triangles();
  while (!stop_requested() && free_witnesses());
  if (stop_requested()) {
    wrap_.vertices = from_;
    return false;
  }
  double most = 0;
  for (size_t v = 0; v < from_.size(); ++v)
    most = std::max(most, (wrap_.vertices[v] - from_[v]).squaredNorm());
  return most > 0.01 * fit_.cell * fit_.cell;
}

void Fitting::gather_stars() {
  first_of_star_.assign(wrap_.vertices.size() + 1, 0);
  for (const Triangle& t : wrap_.triangles)
    for (const uint32_t v : t) ++first_of_star_[v + 1];
  for (size_t v = 1; v < first_of_star_.size(); ++v) first_of_star_[v] += first_of_star_[v - 1];
  stars_.resize(first_of_star_.back());
  std::vector<uint32_t> next(first_of_star_.begin(), first_of_star_.end() - 1);
  for (uint32_t t = 0; t < wrap_.triangles.size(); ++t)
    for (const uint32_t v : wrap_.triangles[t]) stars_[next[v]++] = t;
}

/// How far a point is from the mesh beyond the offset [m].
double Fitting::height(const Vec3& x) const {
  const auto near = mesh_.mesh().closest(x, std::numeric_limits<double>::infinity());
  return near ? std::sqrt(near->squared_distance) - fit_.offset : 0;
}

/// Moves a vertex if all triangles about it are free there and pass over no witness.
bool Fitting::move_alone(uint32_t v, const Vec3& to) {
  const Vec3 before = wrap_.vertices[v];
  Aabb swept;
  swept.include(to);
  for (const uint32_t t : star(v))
    for (const uint32_t corner : wrap_.triangles[t]) swept.include(wrap_.vertices[corner]);
  near_witnesses_.clear();
  mesh_.witnesses_in(swept, near_witnesses_);
  // How often the surface winds about a witness may not change.
  std::vector<int> winding(near_witnesses_.size(), 0);
  const auto count = [&](int sign) {
    for (size_t n = 0; n < winding.size(); ++n)
      for (const uint32_t t : star(v))
        winding[n] += sign * ray_crossing(mesh_.witnesses()[near_witnesses_[n]], corners(wrap_, t));
  };
  const auto put = [&](const Vec3& x) {
    wrap_.vertices[v] = x;
    for (const uint32_t t : star(v)) tree_.set(t, triangle_bounds(wrap_, t));
  };
  count(-1);
  put(to);
  count(1);
  const bool passes =
      std::all_of(winding.begin(), winding.end(), [](int n) { return n == 0; }) &&
      std::all_of(star(v).begin(), star(v).end(), [&](uint32_t t) { return free(t); });
  if (!passes) put(before);
  return passes;
}

/// Takes a vertex nearer to the mesh: to the offset before the point nearest to it, or, where it
/// lies beside its neighbours, before that nearest to the mean of these.
bool Fitting::bring(uint32_t v) {
  const Vec3 x = wrap_.vertices[v];
  const double from = height(x), least = tolerances::above_plane * fit_.cell;
  Vec3 mean = Vec3::Zero();
  for (const uint32_t t : star(v))
    for (const uint32_t corner : wrap_.triangles[t])
      if (corner != v) mean += wrap_.vertices[corner] / (2.0 * double(star(v).size()));
  for (const Vec3& start : {x, mean}) {
    WantedPlane plane;
    if (!plane_before(start, std::numeric_limits<double>::infinity(), plane)) continue;
    const Vec3 goal = start + (plane.at - plane.n.dot(start)) * plane.n;
    for (int halved = 0; halved <= tolerances::most_halvings; ++halved) {
      const Vec3 to = x + std::ldexp(1.0, -halved) * (goal - x);
      if (height(to) < from - least && move_alone(v, to)) return true;
    }
  }
  return false;
}

void Fitting::bring_left_behind() {
  gather_stars();
  const size_t count = wrap_.vertices.size();
  std::vector<uint8_t> follows(count, 1);
  for (size_t t = 0; t < closes_gap_.size(); ++t)
    if (closes_gap_[t])
      for (const uint32_t v : wrap_.triangles[t]) follows[v] = 0;
  std::vector<uint8_t> behind(count, 0);
  for (bool any = true; any && !stop_requested();) {
    for_each(fit_.crew, count, [&](size_t v) {
      behind[v] = follows[v] && height(wrap_.vertices[v]) > tolerances::left_behind * fit_.cell;
    });
    any = false;
    for (uint32_t v = 0; v < count && !stop_requested(); ++v)
      if (behind[v]) any = bring(v) || any;
  }
}

}  // namespace

void fit_wrap(TriangleMesh& wrap, const EnclosedMesh& mesh, const WrapFit& fit) {
  Fitting fitting(wrap, mesh, fit);
  for (int n = 0; n < tolerances::most_passes && fitting.pass(); ++n) {
  }
  if (!stop_requested()) fitting.bring_left_behind();
}

}  // namespace tumble
