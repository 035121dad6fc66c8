#include "viewer/render/microscope_view.hpp"

#include "viewer/render/builtin_meshes.hpp"
#include "viewer/render/extract.hpp"
#include "viewer/render/ink.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

Vec4f opaque(const Vec3f& colour) {
  return {colour.x(), colour.y(), colour.z(), 1};
}

MeshRef mesh_of_surface(const Sketch::Surface& surface) {
  std::vector<Vec3> points;
  std::vector<uint32_t> indices;
  for (const auto& t : surface.triangles)
    for (const Vec3& p : t) {
      indices.push_back(uint32_t(points.size()));
      points.push_back(p);
    }
  return make_mesh_from_triangles(points, indices);
}

}  // namespace

void MicroscopeView::clear() {
  *this = MicroscopeView{};
}

const MicroscopeRecording* MicroscopeView::look(
    const Frame& frame, const std::vector<Pose>& poses, const MicroscopeSetup& setup,
    const std::shared_ptr<const MicroscopeAnswer>& said) {
  refusal_ = microscope_refusal(frame, setup);
  if (!refusal_.empty()) {
    recording_.reset();
    said_.reset();
    return nullptr;
  }
  const bool asks = find_microscope(setup.algorithm)->of_world() != nullptr;
  if (asks && said && said->algorithm == setup.algorithm) return take(frame, said);
  if (asks || said_) recording_.reset();
  said_.reset();
  if (asks) return nullptr;
  MicroscopeSlide slide = make_slide(frame, poses, setup);
  if (recording_ && algorithm_ == setup.algorithm && slide == slide_) return recording();
  if (!memory_) memory_ = std::make_shared<MicroscopeMemory>();
  slide.memory = memory_;
  slide_ = std::move(slide);
  algorithm_ = setup.algorithm;
  recording_ =
      std::make_shared<const MicroscopeRecording>(find_microscope(algorithm_)->record(slide_));
  meshes_of_ = -1;
  return recording();
}

/// A recording made for another tick would show bodies at outdated places.
const MicroscopeRecording* MicroscopeView::take(
    const Frame& frame, const std::shared_ptr<const MicroscopeAnswer>& said) {
  if (said->tick != frame.tick) {
    recording_.reset();
    said_.reset();
    return nullptr;
  }
  if (said_ != said) {
    said_ = said;
    algorithm_ = said->algorithm;
    recording_ = {said, said->recording ? &*said->recording : nullptr};
    meshes_of_ = -1;
  }
  refusal_ = said->refusal;
  return recording();
}

bool MicroscopeView::sees_through(BodyId body) const {
  return recording_ && std::find(recording_->see_through.begin(), recording_->see_through.end(),
                                 body) != recording_->see_through.end();
}

const ParticleColours* MicroscopeView::colours(ParticleSystemId system, int step) const {
  if (!recording_) return nullptr;
  const size_t shown = size_t(std::clamp(step, 0, int(recording_->steps.size()) - 1));
  const auto& colours = recording_->steps[shown].particles;
  return colours && colours->system == system ? &*colours : nullptr;
}

void MicroscopeView::draw_bodies(const Sketch& sketch, ShapeMeshes& meshes,
                                 RenderScene& out) const {
  for (const Sketch::Ghost& ghost : sketch.ghosts) {
    const std::shared_ptr<const Shape>& shape = slide_.body[ghost.body].shape;
    const Vec3f colour = ink_in_world(ghost.body == 0 ? Ink::first : Ink::second);
    const size_t before = out.instances.size();
    if (ghost.opacity > 0) {
      Paint paint;
      paint.colour = colour;
      paint.opacity = ghost.opacity;
      paint.roughness = 0.7f;
      add_shape(shape, ghost.pose, paint, false, meshes, out);
    }
    for (size_t i = before; i < out.instances.size(); ++i) out.instances[i].casts_shadow = false;
    if (ghost.wires)
      add_wires(*shape, ghost.pose, opaque(Vec3f(ghost.opacity > 0.1f ? 0.45f * colour : colour)),
                out);
  }
}

void MicroscopeView::draw_surfaces(const Sketch& sketch, RenderScene& out) {
  if (meshes_of_ != shown_) {
    surfaces_.clear();
    for (const Sketch::Surface& s : sketch.surfaces) surfaces_.push_back(mesh_of_surface(s));
    meshes_of_ = shown_;
  }
  for (size_t i = 0; i < surfaces_.size(); ++i) {
    if (!surfaces_[i]) continue;
    Paint paint;
    paint.colour = ink_in_world(sketch.surfaces[i].ink);
    paint.opacity = sketch.surfaces[i].opacity;
    paint.roughness = 1;
    paint.emission = 0.3f;  // seen from below as well
    MeshInstance instance = mesh_instance(surfaces_[i], Pose{}, Vec3::Ones(), paint);
    instance.casts_shadow = false;
    out.instances.push_back(std::move(instance));
  }
}

void MicroscopeView::draw(int step, bool with_plate, ShapeMeshes& meshes, RenderScene& out) {
  if (!recording_) return;
  shown_ = std::clamp(step, 0, int(recording_->steps.size()) - 1);
  const MicroscopeStep& now = recording_->steps[size_t(shown_)];
  draw_bodies(now.sketch, meshes, out);
  draw_surfaces(now.sketch, out);
  double size = recording_->size;
  for (const Specimen& s : slide_.body)
    if (recording_->size <= 0 && s.shape && std::isfinite(s.shape->bounding_radius()))
      size = std::max(size, s.shape->bounding_radius());
  for (const Sketch::Line& l : now.sketch.lines) {
    const Vec3f colour = ink_in_world(l.ink);
    if (l.arrow) {
      Paint paint;
      paint.colour = colour;
      add_arrow(out, l.a, l.b, 0.018 * size, paint);
    } else {
      out.lines.push_back(
          {l.a.cast<float>(), l.b.cast<float>(), opaque(colour), l.width, Occlusion::faint});
    }
  }
  for (const Sketch::Point& p : now.sketch.points)
    out.points.push_back({p.x.cast<float>(), opaque(ink_in_world(p.ink)), p.size, Occlusion::none});
  for (const Sketch::Label& l : now.sketch.labels) {
    TextLabel label;
    label.text = l.text;
    label.x = l.x.cast<float>();
    label.colour = opaque(ink_in_world(l.ink));
    label.size = 26;
    label.anchor = Vec3f(0.5f, 0.5f, 0);
    label.shadow = false;
    out.texts.push_back(std::move(label));
  }
  if (!with_plate) return;
  Plate& plate = out.plate.emplace();
  plate.heading = recording_->title;
  plate.title = now.title;
  plate.counter = fmt::format("step {} of {}", shown_ + 1, recording_->steps.size());
  plate.caption = now.caption;
  for (const auto& n : now.numbers) plate.numbers.emplace_back(n.label, n.value);
  plate.diagram = now.diagram;
}

}  // namespace tumble
