#include "viewer/render/draw_plan.hpp"

#include "viewer/render/builtin_meshes.hpp"
#include "viewer/render/sphere_plan.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

enum class Layer : uint8_t { opaque, blended, outlined, casters, low, none };

/// One instance in one layer, before sorting.
struct Item {
  Layer layer;
  const MeshRef* mesh;  ///< of the scene, or a coarser version
  float order;          ///< within the mesh; for blended ones over all meshes
  uint32_t source;      ///< in the entries
  bool patterned;       ///< see Batch
};

/// A body that is drawn in at least one layer.
struct Entry {
  const MeshRef* mesh;
  GpuInstance gpu;
  Vec3 centre;
  double radius;
  bool selected, casts_shadow, blended;
  bool ball;  ///< drawn as an impostor
  double ball_radius;
};

std::array<float, 4> four(const Vec3f& v, float w) {
  return {v.x(), v.y(), v.z(), w};
}

GpuInstance pack(const MeshInstance& i) {
  GpuInstance g;
  for (int r = 0; r < 3; ++r)
    g.rows[size_t(r)] = four(i.transform.linear.row(r).transpose(), i.transform.offset[r]);
  const Paint& m = i.paint;
  g.colour = four(m.colour, m.opacity);
  g.look = {std::clamp(m.roughness, 0.05f, 1.f), m.metallic, m.emission, i.inflate};
  g.pattern = {float(m.pattern), m.pattern_strength, std::max(m.pattern_size, 1e-4f),
               m.pattern_shift};
  return g;
}

/// Factor by which the transform lengthens each axis.
Vec3f lengthening(const Mat3f& linear) {
  return {linear.col(0).norm(), linear.col(1).norm(), linear.col(2).norm()};
}

/// Centre and radius of the bounding sphere in the world.
void bound(const MeshInstance& i, Vec3& centre, double& radius) {
  const MeshData& m = *i.mesh;
  const Mat3f& l = i.transform.linear;
  centre = (l * (0.5f * (m.min + m.max)) + i.transform.offset).cast<double>();
  const Vec3f half = 0.5f * (m.max - m.min);
  const Vec3f axes = lengthening(l);
  radius = double(axes.cwiseProduct(half).norm() + 1.7321f * i.inflate);
}

/// The coarsest version that is good enough.
const MeshRef& detail(const MeshRef& mesh, double pixels, double inflate_pixels) {
  const MeshRef* m = &mesh;
  while ((*m)->coarser && (pixels < double((*m)->coarser_below_pixels) ||
                           inflate_pixels < double((*m)->coarser_below_inflate)))
    m = &(*m)->coarser;
  return *m;
}

/// Radius of an undistorted sphere [m]; 0 for everything else.
double radius_of_ball(const MeshInstance& i) {
  if (i.inflate != 0 || i.mesh->id != sphere_mesh()->id) return 0;
  const Vec3f axes = lengthening(i.transform.linear);
  const float r = axes[0];
  return (axes - Vec3f::Constant(r)).cwiseAbs().maxCoeff() <= 1e-4f * r ? double(r) : 0;
}

class Planner {
 public:
  Planner(const RenderScene& scene, const ViewSetup& view, DrawPlan& plan)
      : scene_(scene), view_(view), plan_(plan), frustum_(frustum_of(view.clip_from_world)) {}

  void run() {
    plan_.instances.clear();
    for (auto* list : {&plan_.opaque, &plan_.blended, &plan_.outlined, &plan_.casters, &plan_.low})
      list->clear();
    plan_.visible = plan_.culled = 0;
    entries_.reserve(scene_.instances.size());
    for (const MeshInstance& i : scene_.instances) {
      if (!i.mesh || i.mesh->indices.empty() || !i.transform.offset.allFinite() ||
          !i.transform.linear.allFinite())
        continue;
      Entry e{&i.mesh, pack(i), {}, 0, i.selected, i.casts_shadow, i.paint.opacity < 1, false, 0};
      bound(i, e.centre, e.radius);
      e.ball_radius = radius_of_ball(i);
      // With the eye inside, or nearly, the sphere has no outline for an impostor.
      e.ball = e.ball_radius > 0 && !e.blended &&
               (e.centre - view_.eye).squaredNorm() > 1.05 * e.ball_radius * e.ball_radius;
      add(e);
    }
    leave_out_hidden_balls();
    sort_items();
    emit();
  }
  const std::vector<GpuSphere>& ball_casters() const { return ball_casters_; }

 private:
  void add(const Entry& e) {
    const double depth = std::max((e.centre - view_.eye).dot(view_.forward), 1e-3);
    const double scale = view_.pixels_per_radian / depth;
    const double pixels = e.radius * scale, inflate = double(e.gpu.look[3]) * scale;
    const bool seen = frustum_.sees_sphere(e.centre, e.radius) && pixels > 0.2;
    const bool casts = view_.shadows && e.casts_shadow && !e.blended &&
                       view_.shadow_volume.sees_sphere(e.centre, e.radius);
    const uint32_t source = uint32_t(entries_.size());
    seen ? ++plan_.visible : ++plan_.culled;
    if (!seen && !casts) return;
    entries_.push_back(e);
    if (seen) {
      static const MeshRef card = ball_card();
      const MeshRef& mesh = detail(*e.mesh, pixels, inflate);
      push(e.blended ? Layer::blended : Layer::opaque, e.ball ? card : mesh,
           float(e.blended ? -depth : depth), source);
      if (e.selected) push(Layer::outlined, mesh, 0, source);
    }
    // Shadows are blurred, so half the detail is enough.
    if (casts && e.ball)
      ball_casters_.push_back({{float(e.centre.x()), float(e.centre.y()), float(e.centre.z())},
                               float(e.ball_radius),
                               e.gpu.colour});
    else if (casts)
      push(Layer::casters, detail(*e.mesh, 0.4 * pixels, 0.4 * inflate), 0, source);
    if (casts && e.centre.y() - e.radius < view_.contact_below)
      push(Layer::low, detail(*e.mesh, 0, 0), 0, source);
  }
  void push(Layer layer, const MeshRef& mesh, float order, uint32_t source) {
    const bool patterned = layer == Layer::opaque && entries_[source].gpu.pattern[0] > 0.5f;
    items_.push_back({layer, &mesh, order, source, patterned});
  }

  /// Impostors are tested for depth after they are shaded, since the shader computes the depth:
  /// hidden balls would cost as much as visible ones.
  void leave_out_hidden_balls() {
    std::vector<size_t> which;
    std::vector<ProjectedDisc> discs;
    for (size_t i = 0; i < items_.size(); ++i) {
      const Entry& e = entries_[items_[i].source];
      if (items_[i].layer != Layer::opaque || !e.ball) continue;
      const ProjectedDisc disc = disc_in_picture(view_, e.centre, e.ball_radius, true);
      if (!(disc.outline_radius > 0)) continue;
      which.push_back(i);
      discs.push_back(disc);
    }
    if (discs.size() < 2) return;
    std::vector<uint8_t> hidden;
    DiscOcclusion occlusion;
    find_hidden(occlusion, discs, view_.width, view_.height, hidden);
    for (size_t k = which.size(); k-- > 0;) {
      if (!hidden[k]) continue;
      items_[which[k]].layer = Layer::none;
      --plan_.visible;
      ++plan_.culled;
    }
    std::erase_if(items_, [](const Item& item) { return item.layer == Layer::none; });
  }

  void sort_items() {
    std::sort(items_.begin(), items_.end(), [](const Item& a, const Item& b) {
      if (a.layer != b.layer) return a.layer < b.layer;
      if (a.layer != Layer::blended && a.mesh != b.mesh && (*a.mesh)->id != (*b.mesh)->id)
        return (*a.mesh)->id < (*b.mesh)->id;
      if (a.patterned != b.patterned) return b.patterned;
      if (a.order != b.order) return a.order < b.order;
      return a.source < b.source;
    });
  }

  void emit() {
    plan_.instances.reserve(items_.size());
    const Item* last = nullptr;
    for (const Item& item : items_) {
      std::vector<Batch>& list = item.layer == Layer::opaque     ? plan_.opaque
                                 : item.layer == Layer::blended  ? plan_.blended
                                 : item.layer == Layer::outlined ? plan_.outlined
                                 : item.layer == Layer::casters  ? plan_.casters
                                                                 : plan_.low;
      const bool joins = last && last->layer == item.layer &&
                         (*last->mesh)->id == (*item.mesh)->id && last->patterned == item.patterned;
      if (!joins) list.push_back({*item.mesh, uint32_t(plan_.instances.size()), 0, item.patterned});
      ++list.back().count;
      plan_.instances.push_back(fitted(item));
      last = &item;
    }
  }

  GpuInstance fitted(const Item& item) const {
    const Entry& e = entries_[item.source];
    GpuInstance g = e.gpu;
    const bool plain = (*item.mesh)->takes_scale;
    if (g.look[3] > 0 && plain) {
      for (size_t c = 0; c < 3; ++c) {
        const float l = std::sqrt(g.rows[0][c] * g.rows[0][c] + g.rows[1][c] * g.rows[1][c] +
                                  g.rows[2][c] * g.rows[2][c]);
        const float grow = l > 0 ? (l + g.look[3]) / l : 1;
        for (auto& row : g.rows) row[c] *= grow;
      }
      g.look[3] = 0;
    }
    if (e.selected && item.layer != Layer::outlined)  // the outline may be hidden in a heap
      for (size_t c = 0; c < 3; ++c)
        g.colour[c] += 0.3f * (scene_.selection_colour[int(c)] - g.colour[c]);
    if (item.layer != Layer::blended) g.colour[3] = 0;  // what is left of what is behind
    if (item.layer == Layer::outlined) {
      const double depth = std::max((e.centre - view_.eye).dot(view_.forward), 1e-3);
      const float pixel = float(depth / view_.pixels_per_radian);
      const Vec4f& c = scene_.selection_colour;
      g.colour = {c.x(), c.y(), c.z(), 0};
      g.look[3] += 2.5f * scene_.ui_scale * scene_.resolution * pixel;
    }
    return g;
  }

  const RenderScene& scene_;
  const ViewSetup& view_;
  DrawPlan& plan_;
  Frustum frustum_;
  std::vector<Entry> entries_;
  std::vector<Item> items_;
  std::vector<GpuSphere> ball_casters_;
};

}  // namespace

void make_draw_plan(const RenderScene& scene, const ViewSetup& view, DrawPlan& plan) {
  Planner planner(scene, view, plan);
  planner.run();
  plan_spheres(scene, view, plan);
  const std::vector<GpuSphere>& balls = planner.ball_casters();
  plan.ball_casters = {uint32_t(plan.sphere_vertices.size() / 3), uint32_t(balls.size())};
  for (const GpuSphere& ball : balls)
    plan.sphere_vertices.insert(plan.sphere_vertices.end(), 3, ball);
}

}  // namespace tumble
