#include "engine/collision/continuous/mesh_advancement.hpp"

#include "engine/collision/continuous/advancement.hpp"
#include "engine/collision/triangle_core.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr int max_parts = 64;

/// The vertices of a mesh as a convex core: for a half-space only their hull counts.
class VertexCore final : public ConvexCore {
 public:
  explicit VertexCore(const TriangleMesh& mesh) : mesh_(mesh) {
    double reach = 0;
    for (const Vec3& v : mesh.vertices) reach = std::max(reach, v.norm());
    view_ = CoreView::of_reach(reach, mesh.vertices[0]);
  }
  Vec3 support(const Vec3& d) const override {
    const Vec3* best = &mesh_.vertices[0];
    double height = d.dot(*best);
    for (const Vec3& v : mesh_.vertices) {
      const double h = d.dot(v);
      if (h > height) height = h, best = &v;
    }
    return *best;
  }
  void supporting_face(const Vec3& d, SupportingFace& face) const override {
    face.count = 0;
    face.add(support(d), 0);
  }

 private:
  const TriangleMesh& mesh_;
};

TriangleCore triangle_core(const MeshSurface& s, uint32_t t) {
  return {s.mesh->corner(t, 0), s.mesh->corner(t, 1), s.mesh->corner(t, 2)};
}

double triangle_lever(const MeshSurface& s, uint32_t t, const Motion& m) {
  double lever = 0;
  for (size_t k = 0; k < 3; ++k)
    lever = std::max(lever, m.offset.point(s.mesh->corner(t, k)).norm());
  return lever;
}

/// The interval in equal parts, each moving the pair by about `size` at most.
int parts_of(double t0, double t1, double speed, double size) {
  if (!(size > 0)) return max_parts;
  return int(std::clamp(std::ceil(speed * (t1 - t0) / size), 1.0, double(max_parts)));
}

/// Takes `found` when it is an earlier hit; `best` starts as separated at t1.
void keep_earlier(TimeOfContact& best, const TimeOfContact& found, uint32_t ta, uint32_t tb,
                  bool first_part) {
  const int iterations = best.iterations + found.iterations;
  const bool initial = found.status == TimeOfContactStatus::initially_overlapping;
  // Too close already at the start of a later part: touched, exactly there.
  const bool hit = found.hit() || (initial && !first_part);
  const bool unknown = found.status == TimeOfContactStatus::max_iterations;
  if ((hit || unknown) && found.time < best.time) {
    best = found;
    if (hit) best.status = TimeOfContactStatus::contact;
    best.triangle_a = ta, best.triangle_b = tb;
  }
  best.iterations = iterations;
}

/// Marks the answer when nothing was hit but something was near from the start.
struct InitialContact {
  TimeOfContact nearest;
  bool any = false;
  void note(const TimeOfContact& found, uint32_t ta, uint32_t tb) {
    if (any && nearest.distance_low <= found.distance_low) return;
    nearest = found, any = true;
    nearest.triangle_a = ta, nearest.triangle_b = tb;
  }
};

TimeOfContact nothing_until(double t) {
  TimeOfContact r;
  r.time = r.low = r.high = t;
  return r;
}

TimeOfContact answer(const TimeOfContact& best, const InitialContact& initial, double t1) {
  if (best.time < t1 || best.hit() || !initial.any) return best;
  TimeOfContact r = initial.nearest;
  r.iterations = best.iterations;
  return r;
}

}  // namespace

TimeOfContact advance_convex_mesh(const Shape& a, const Motion& motion_a, const MeshSurface& b,
                                  const Motion& motion_b, double lever_b, double tolerance) {
  const double t0 = motion_a.t0, t1 = motion_a.t1;
  const ConvexShape& core = *a.convex();
  const MovingCore moving{core, motion_a, motion_a.lever(a.bounding_radius())};
  const double speed = motion_a.speed_bound(moving.lever) + motion_b.speed_bound(lever_b);
  const int parts = parts_of(t0, t1, speed, a.bounding_radius());
  TimeOfContact best = nothing_until(t1);
  InitialContact initial;
  std::vector<uint32_t> triangles, skipped;
  for (int part = 0; part < parts; ++part) {
    const double from = t0 + (t1 - t0) * part / parts;
    const double to = part + 1 == parts ? t1 : t0 + (t1 - t0) * (part + 1) / parts;
    const double middle = 0.5 * (from + to);
    const Pose relative = motion_b.pose(middle).inverse() * motion_a.pose(middle);
    const double reach = 0.5 * speed * (to - from) + 2 * tolerance;
    triangles.clear();
    b.tree->overlap(a.bounds(relative).inflated(reach), triangles);
    for (uint32_t t : triangles) {
      if (std::binary_search(skipped.begin(), skipped.end(), t)) continue;
      const TriangleCore triangle = triangle_core(b, t);
      const MovingCore other{triangle, motion_b, triangle_lever(b, t, motion_b)};
      const TimeOfContact found = advance(moving, other, from, std::min(to, best.time), tolerance);
      if (part == 0 && found.status == TimeOfContactStatus::initially_overlapping) {
        initial.note(found, 0, t);
        skipped.push_back(t);
      }
      keep_earlier(best, found, 0, t, part == 0);
    }
    if (best.status != TimeOfContactStatus::separated) break;
  }
  return answer(best, initial, t1);
}

TimeOfContact advance_mesh_mesh(const MeshSurface& a, const Motion& motion_a, double lever_a,
                                const MeshSurface& b, const Motion& motion_b, double lever_b,
                                double tolerance) {
  const double t0 = motion_a.t0, t1 = motion_a.t1;
  const double speed = motion_a.speed_bound(lever_a) + motion_b.speed_bound(lever_b);
  const int parts = parts_of(t0, t1, speed, 0.25 * std::min(a.size, b.size));
  TimeOfContact best = nothing_until(t1);
  InitialContact initial;
  std::vector<TriangleIds> pairs, skipped;
  for (int part = 0; part < parts; ++part) {
    const double from = t0 + (t1 - t0) * part / parts;
    const double to = part + 1 == parts ? t1 : t0 + (t1 - t0) * (part + 1) / parts;
    const double middle = 0.5 * (from + to);
    const Pose relative = motion_a.pose(middle).inverse() * motion_b.pose(middle);
    pairs.clear();
    box_pairs(*a.tree, *b.tree, relative, 0.5 * speed * (to - from) + 2 * tolerance, pairs);
    for (const TriangleIds& ids : pairs) {
      if (std::binary_search(skipped.begin(), skipped.end(), ids)) continue;
      const TriangleCore ta = triangle_core(a, ids.a), tb = triangle_core(b, ids.b);
      const MovingCore ma{ta, motion_a, triangle_lever(a, ids.a, motion_a)};
      const MovingCore mb{tb, motion_b, triangle_lever(b, ids.b, motion_b)};
      const TimeOfContact found = advance(ma, mb, from, std::min(to, best.time), tolerance);
      if (part == 0 && found.status == TimeOfContactStatus::initially_overlapping) {
        initial.note(found, ids.a, ids.b);
        skipped.push_back(ids);
      }
      keep_earlier(best, found, ids.a, ids.b, part == 0);
    }
    if (best.status != TimeOfContactStatus::separated) break;
  }
  return answer(best, initial, t1);
}

TimeOfContact advance_half_space_mesh(const Motion& plane, const MeshSurface& b,
                                      const Motion& motion_b, double lever_b, double tolerance) {
  const VertexCore core(*b.mesh);
  return advance_half_space(plane, {core, motion_b, lever_b}, plane.t0, plane.t1, tolerance);
}

}  // namespace tumble
