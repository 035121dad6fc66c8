#include "engine/world/microscope/world_copy.hpp"

#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/core/stop.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// A mesh of more triangles is drawn as a point: sketches are drawn twice a step and for each step,
/// and the edges of a larger mesh would be millions of lines, all black.
constexpr size_t most_outlined = 2000;

/// Draws the lines of a shape into a sketch.
class SketchLines final : public DebugDraw {
 public:
  SketchLines(Sketch& out, const Pose& pose, Ink ink, float width)
      : out_(out), pose_(pose), ink_(ink), width_(width) {}
  void line(const Vec3& a, const Vec3& b, const Vec4f&) override {
    out_.line(pose_.point(a), pose_.point(b), ink_, width_);
  }
  void point(const Vec3& x, const Vec4f&, float) override { out_.point(pose_.point(x), ink_, 4); }
  void text(const Vec3&, const Vec4f&, std::string_view) override {}

 private:
  Sketch& out_;
  Pose pose_;
  Ink ink_;
  float width_;
};

}  // namespace

Result<std::unique_ptr<World>> copy_of(const World& world, std::string_view stepper) {
  WorldDef def;
  def.threads = 1;
  auto made = World::create(std::move(def));
  if (!made) return made;
  (*made)->stop_with(Stoppable::present());  // a stop of the caller stops the copy
  if (const Status loaded = (*made)->load(world.save()); !loaded) return loaded.error();
  if (stepper.empty() || world.settings().stepper == stepper) return made;
  WorldSettings settings = world.settings();
  settings.stepper = stepper;
  if (const Status set = (*made)->set_settings(settings); !set) return set.error();
  return made;
}

std::string moving_body_refusal(const Frame& frame, BodyId body, std::string_view wanted) {
  if (body.is_null()) return fmt::format("no body is chosen: select one to see {}", wanted);
  if (body.index >= frame.body_slots() || frame.body(body.index).id != body)
    return "body A is gone";
  if (frame.info(body.index).type == BodyType::dynamic) return {};
  return fmt::format("forces do not move '{}': select a body that they move",
                     frame.info(body.index).name);
}

std::string body_text(const Frame& frame, uint32_t slot) {
  if (slot >= frame.body_slots() || frame.body(slot).id.is_null()) return "a particle";
  const std::string& name = frame.info(slot).name;
  return name.empty() ? fmt::format("body {}", slot) : name;
}

void draw_outline(Sketch& out, const BodyInfo& info, const Pose& pose, Ink ink, float width) {
  for (const BodyShape& part : info.shapes) {
    if (part.shape->is_half_space()) continue;
    if (const auto* mesh = part.shape->polyhedral();
        mesh && mesh->surface().mesh->triangles.size() > most_outlined) {
      out.point((pose * part.pose).x, ink);
      continue;
    }
    SketchLines lines(out, pose * part.pose, ink, width);
    part.shape->outline(lines, Vec4f::Ones());
  }
}

double body_size(const BodyInfo& info) {
  double out = 0;
  for (const BodyShape& part : info.shapes)
    if (const double r = part.shape->bounding_radius(); std::isfinite(r)) out = std::max(out, r);
  return out;
}

}  // namespace tumble
