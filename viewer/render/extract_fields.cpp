#include "viewer/render/builtin_meshes.hpp"
#include "viewer/render/extract.hpp"
#include "viewer/render/overlay_colours.hpp"
#include "viewer/render/scene_scales.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Bounds of most of the things that a field acts on.
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

/// Arrows of one kind, scaled so that the longest is a little shorter than the lattice spacing and
/// none reaches the next.
void draw_field(const std::vector<FieldArrow>& arrows, double spacing, const Vec4f& colour,
                RenderScene& out) {
  double most = 0;
  for (const FieldArrow& a : arrows) most = std::max(most, a.value.norm());
  if (!(most > 0)) return;
  Paint paint;
  paint.colour = colour.head<3>();
  paint.emission = 0.4f;
  for (const FieldArrow& a : arrows) {
    const double size = a.value.norm();
    if (!(size > 1e-3 * most)) continue;
    // The square root keeps the direction visible where the field is weak.
    const Vec3 along = 0.8 * spacing * std::sqrt(size / most) * a.value / size;
    const double radius = std::min(0.025 * spacing, 0.1 * along.norm());
    add_arrow(out, a.x - 0.5 * along, a.x + 0.5 * along, radius, paint);
  }
}

/// Lattice of points in a box where arrows are drawn: about as many in the volume, and at most as
/// many along an edge, as can be told apart in a picture.
struct Lattice {
  static constexpr double places = 60, along_edge = 6;

  explicit Lattice(const Aabb& box) : corner(box.min) {
    const Vec3 size = box.max - box.min;
    spacing = std::max(size.maxCoeff() / along_edge, std::cbrt(size.prod() / places));
    for (int axis = 0; axis < 3; ++axis) {
      int& n = count[size_t(axis)] = std::max(1, int(size[axis] / spacing + 0.5));
      corner[axis] += 0.5 * (size[axis] - (n - 1) * spacing);
    }
  }
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (int i = 0; i < count[0]; ++i)
      for (int j = 0; j < count[1]; ++j)
        for (int k = 0; k < count[2]; ++k) visit(Vec3(corner + spacing * Vec3(i, j, k)));
  }

  Vec3 corner;         ///< the first place [m]
  double spacing = 0;  ///< [m]
  std::array<int, 3> count;
};

/// The sum of fields that act on the same things.
void draw_fields(const Frame& frame, const std::vector<const ForceDef*>& fields, Aabb bounds,
                 RenderScene& out) {
  if (bounds.empty() || !bounds.min.allFinite() || !bounds.max.allFinite()) return;
  const double margin = 2 * typical_size(frame);
  const Lattice lattice(bounds.inflated(margin));
  for (const bool flow : {true, false}) {
    // The two kinds are shifted against each other, so that no two arrows cross.
    const Vec3 shift = Vec3::Constant((flow ? -0.25 : 0.25) * lattice.spacing);
    std::vector<FieldArrow> arrows;
    lattice.for_each([&](const Vec3& x) {
      FieldArrow arrow{x + shift, Vec3::Zero()};
      for (const ForceDef* def : fields)
        if (const auto sample = sample_field(*def, arrow.x, frame.time);
            sample && sample->flow == flow)
          arrow.value += sample->value;
      arrows.push_back(arrow);
    });
    draw_field(arrows, lattice.spacing, flow ? overlay_colour::flow : overlay_colour::pull, out);
  }
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
