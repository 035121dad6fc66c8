#include "viewer/render/sphere_plan.hpp"

#include "viewer/render/disc_occlusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

/// The draws that a sphere takes part in. Sorted in this order, the spheres of each draw are
/// contiguous: visible ones first, casters from the second kind on, those near the ground in the
/// middle of the casters.
enum class Role : uint8_t { seen, seen_casts, seen_low, low, casts, none };
constexpr size_t roles = 5;

/// Discs wider than this [px] are culled in a coarser raster.
constexpr float fine_radius = 8;

/// A sphere in the two views (camera and sun).
struct Sight {
  uint32_t source;
  double depth;  ///< of the centre, along the view [m]
  bool seen, casts, low;
};

class Sorter {
 public:
  Sorter(const RenderScene& scene, const ViewSetup& view)
      : scene_(scene), view_(view), frustum_(frustum_of(view.clip_from_world)) {}

  std::vector<Sight> run() {
    std::vector<Sight> sights;
    sights.reserve(scene_.spheres.size());
    for (uint32_t i = 0; i < scene_.spheres.size(); ++i) {
      const SphereInstance& s = scene_.spheres[i];
      if (drawable(s)) sights.push_back(sight(i, s));
    }
    hide(sights, &Sight::seen, &Sorter::camera_disc, view_.width, view_.height);
    hide(sights, &Sight::casts, &Sorter::sun_disc, view_.shadow_size, view_.shadow_size);
    return sights;
  }

 private:
  Sight sight(uint32_t i, const SphereInstance& s) const {
    const Vec3 x = s.centre.cast<double>();
    const double r = double(s.radius), depth = (x - view_.eye).dot(view_.forward);
    Sight out{i, depth, false, false, false};
    out.seen = frustum_.sees_sphere(x, r) && (x - view_.eye).squaredNorm() > 1.05 * r * r &&
               r * view_.pixels_per_radian > 0.2 * depth;
    out.casts = view_.shadows && s.colour.w() >= 1 && view_.shadow_volume.sees_sphere(x, r);
    out.low = out.casts && x.y() - r < view_.contact_below;
    return out;
  }

  ProjectedDisc camera_disc(const Sight& sight) const {
    const SphereInstance& s = scene_.spheres[sight.source];
    return disc_in_picture(view_, s.centre.cast<double>(), double(s.radius), s.colour.w() >= 1);
  }
  ProjectedDisc sun_disc(const Sight& sight) const {
    const SphereInstance& s = scene_.spheres[sight.source];
    const Vec3 x = s.centre.cast<double>();
    const Vec4 p = view_.shadow_from_world * Vec4(x.x(), x.y(), x.z(), 1);
    const float texels = float(view_.shadow_size * view_.shadow_from_world.row(0).head<3>().norm());
    return {float(p.x() * view_.shadow_size), float(p.y() * view_.shadow_size),
            s.radius * texels - 0.05f,        float(p.z()),
            s.radius * texels + 0.05f,        float(p.z())};
  }

  /// Clears `flag` for those that other spheres hide in this view. Spheres near the ground remain
  /// casters, since they darken the ground below them.
  void hide(std::vector<Sight>& sights, bool Sight::*flag,
            ProjectedDisc (Sorter::*disc_of)(const Sight&) const, int width, int height) {
    std::vector<uint32_t> which;
    std::vector<ProjectedDisc> discs;
    for (uint32_t i = 0; i < sights.size(); ++i) {
      if (!(sights[i].*flag)) continue;
      const ProjectedDisc d = (this->*disc_of)(sights[i]);
      if (!(d.outline_radius > 0)) continue;
      which.push_back(i);
      discs.push_back(d);
    }
    if (discs.empty()) return;
    find_hidden(occlusion_, discs, width, height, hidden_);
    for (size_t k = 0; k < which.size(); ++k)
      if (hidden_[k] && !(flag == &Sight::casts && sights[which[k]].low))
        sights[which[k]].*flag = false;
  }
  const RenderScene& scene_;
  const ViewSetup& view_;
  Frustum frustum_;
  DiscOcclusion occlusion_;
  std::vector<uint8_t> hidden_;
};

Role role_of(const Sight& s) {
  if (s.seen) return s.low ? Role::seen_low : s.casts ? Role::seen_casts : Role::seen;
  return s.low ? Role::low : s.casts ? Role::casts : Role::none;
}

GpuSphere pack(const SphereInstance& s) {
  return {{s.centre.x(), s.centre.y(), s.centre.z()},
          s.radius,
          {s.colour.x(), s.colour.y(), s.colour.z(), s.colour.w()}};
}

void put(DrawPlan& plan, uint32_t place, const SphereInstance& s) {
  const GpuSphere g = pack(s);
  for (uint32_t k = 0; k < 3; ++k) plan.sphere_vertices[3 * place + k] = g;
}

/// Converts discs to coarser cells: covered means wholly covered, touched means partly.
void coarsen(std::vector<ProjectedDisc>& discs, float by) {
  for (ProjectedDisc& d : discs) {
    d.x /= by;
    d.y /= by;
    d.cover_radius = d.cover_radius / by - 0.75f;
    d.outline_radius = d.outline_radius / by + 0.75f;
  }
}

}  // namespace

ProjectedDisc disc_in_picture(const ViewSetup& view, const Vec3& centre, double radius,
                              bool covers) {
  const Vec3 d = centre - view.eye;
  const double f = view.pixels_per_radian, depth = d.dot(view.forward), near = depth - radius;
  if (!(near > 0.01 * radius)) return {};  // around the eye: hides nothing, is not hidden
  const double x = d.dot(view.right) / depth, y = d.dot(view.up) / depth;
  const double stretch = std::sqrt(1 + x * x + y * y);
  ProjectedDisc p;
  p.x = float(0.5 * view.width + f * x);
  p.y = float(0.5 * view.height + f * y);
  p.cover_radius = covers ? float(f * radius / depth) - 0.5f : 0;
  p.cover_depth = float(depth);
  p.outline_radius = float(f * radius * stretch / near) + 0.5f;
  p.nearest_depth = float(near);
  return p;
}

void find_hidden(DiscOcclusion& occlusion, std::vector<ProjectedDisc>& discs, int width, int height,
                 std::vector<uint8_t>& hidden) {
  double sum = 0;
  for (const ProjectedDisc& d : discs) sum += double(d.outline_radius);
  const float coarse = std::ceil(float(sum / double(discs.size())) / fine_radius);
  if (coarse > 1) coarsen(discs, coarse);
  const float cell = std::max(coarse, 1.0f);
  occlusion.find_hidden(discs, int(std::ceil(float(width) / cell)),
                        int(std::ceil(float(height) / cell)), hidden);
}

void plan_spheres(const RenderScene& scene, const ViewSetup& view, DrawPlan& plan) {
  const std::vector<Sight> sights = Sorter(scene, view).run();
  std::array<uint32_t, roles + 1> first{};
  std::vector<Sight> ghosts;
  for (const Sight& s : sights) {
    s.seen ? ++plan.visible : ++plan.culled;
    if (s.seen && scene.spheres[s.source].colour.w() < 1)
      ghosts.push_back(s);
    else if (role_of(s) != Role::none)
      ++first[size_t(role_of(s)) + 1];
  }
  for (size_t r = 0; r < roles; ++r) first[r + 1] += first[r];
  plan.opaque_spheres = {0, first[3]};
  plan.sphere_casters = {first[1], first[5] - first[1]};
  plan.low_spheres = {first[2], first[4] - first[2]};
  plan.blended_spheres = {first[5], uint32_t(ghosts.size())};

  plan.sphere_vertices.resize(3 * (first[5] + ghosts.size()));
  std::sort(ghosts.begin(), ghosts.end(), [](const Sight& a, const Sight& b) {
    return a.depth != b.depth ? a.depth > b.depth : a.source < b.source;
  });
  for (uint32_t k = 0; k < ghosts.size(); ++k)
    put(plan, first[5] + k, scene.spheres[ghosts[k].source]);
  for (const Sight& s : sights) {
    const SphereInstance& sphere = scene.spheres[s.source];
    if (sphere.colour.w() >= 1 && role_of(s) != Role::none)
      put(plan, first[size_t(role_of(s))]++, sphere);
  }
}

}  // namespace tumble
