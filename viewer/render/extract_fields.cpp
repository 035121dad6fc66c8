#include "viewer/render/extract.hpp"
#include "viewer/render/overlay_colours.hpp"
#include "viewer/render/scene_scales.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Where most of the things are that a field acts on.
Aabb target_bounds(const Frame& frame, const std::vector<Pose>& poses,
                   const FieldTargets& targets) {
  const auto named = [&](const auto& ids, auto id) {
    return targets.everything() || std::find(ids.begin(), ids.end(), id) != ids.end();
  };
  std::vector<Aabb> places;
  for (size_t slot = 0; slot < poses.size(); ++slot) {
    const BodyId id = frame.body(slot).id;
    if (!id.is_null() && frame.info(slot).type == BodyType::dynamic && named(targets.bodies, id))
      places.push_back({poses[slot].x, poses[slot].x});
  }
  for (const auto& system : frame.particles)
    if (named(targets.particles, system->id))
      for (const Vec3& x : system->x) places.push_back({x, x});
  return bounds_of_most(places);
}

struct FieldArrow {
  Vec3 x, value;
};

/// Arrows of one kind, the longest as long as the lattice is wide.
void draw_field(const std::vector<FieldArrow>& arrows, double spacing, const Vec4f& colour,
                RenderScene& out) {
  double most = 0;
  for (const FieldArrow& a : arrows) most = std::max(most, a.value.norm());
  if (!(most > 0)) return;
  for (const FieldArrow& a : arrows) {
    const double size = a.value.norm();
    if (!(size > 1e-3 * most)) continue;
    // Square roots, so that weak places still show which way it goes.
    const Vec3 tip = a.x + 0.9 * spacing * std::sqrt(size / most) * a.value / size;
    out.lines.push_back(
        {.a = a.x.cast<float>(), .b = tip.cast<float>(), .colour = colour, .width = 2});
    out.points.push_back({.x = tip.cast<float>(), .colour = colour, .size = 4.5f});
  }
}

/// What fields on the same things do together there.
void draw_fields(const Frame& frame, const std::vector<const ForceDef*>& fields, Aabb bounds,
                 RenderScene& out) {
  if (bounds.empty() || !bounds.min.allFinite() || !bounds.max.allFinite()) return;
  const double margin = 2 * typical_size(frame);
  bounds.min.array() -= margin;
  bounds.max.array() += margin;
  const Vec3 size = bounds.max - bounds.min;
  const double spacing = std::max(size.maxCoeff() / 9, std::cbrt(size.prod() / 400));
  std::vector<FieldArrow> flows, pulls;
  const auto count = [&](int axis) { return std::max(1, int(size[axis] / spacing + 0.5)); };
  for (int i = 0; i < count(0); ++i) {
    for (int j = 0; j < count(1); ++j) {
      for (int k = 0; k < count(2); ++k) {
        const Vec3 x = bounds.min + spacing * Vec3(i + 0.5, j + 0.5, k + 0.5);
        FieldArrow flow{x, Vec3::Zero()}, pull{x, Vec3::Zero()};
        for (const ForceDef* def : fields)
          if (const auto sample = sample_field(*def, x, frame.time))
            (sample->flow ? flow : pull).value += sample->value;
        flows.push_back(flow);
        pulls.push_back(pull);
      }
    }
  }
  draw_field(flows, spacing, overlay_colour::flow, out);
  draw_field(pulls, spacing, overlay_colour::pull, out);
}

}  // namespace

void add_fields(const Frame& frame, const std::vector<Pose>& poses, RenderScene& out) {
  std::vector<const ForceDef*> left;
  for (const ForceFrame& f : frame.forces)
    if (field_targets(f.def)) left.push_back(&f.def);
  while (!left.empty()) {
    const FieldTargets& targets = *field_targets(*left.front());
    const auto others = std::stable_partition(left.begin(), left.end(), [&](const ForceDef* def) {
      const FieldTargets& t = *field_targets(*def);
      return t.bodies == targets.bodies && t.particles == targets.particles;
    });
    draw_fields(frame, {left.begin(), others}, target_bounds(frame, poses, targets), out);
    left.erase(left.begin(), others);
  }
}

}  // namespace tumble
