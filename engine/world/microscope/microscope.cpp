#include "engine/world/microscope/microscope.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/text.hpp"
#include "engine/world/microscope/contact_time_steps.hpp"
#include "engine/world/microscope/density_steps.hpp"
#include "engine/world/microscope/descent_steps.hpp"
#include "engine/world/microscope/event_steps.hpp"
#include "engine/world/microscope/gjk_steps.hpp"
#include "engine/world/microscope/pivot_steps.hpp"
#include "engine/world/microscope/tolerances.hpp"
#include "engine/world/microscope/v_clip_steps.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

const BodyInfo* find_info(const Frame& frame, BodyId id) {
  const bool there =
      !id.is_null() && id.index < frame.body_slots() && frame.body(id.index).id == id;
  return there ? &frame.info(id.index) : nullptr;
}

Specimen specimen(const Frame& frame, const std::vector<Pose>& poses, BodyId id, double span) {
  const BodyInfo& info = frame.info(id.index);
  Specimen s;
  s.name = info.name;
  s.shape = info.shapes.front().shape;
  s.motion = Motion::at_rest(poses[id.index], 0, span);
  s.motion.velocity = frame.body(id.index).v;
  s.motion.omega = frame.body(id.index).omega;
  s.motion.offset = info.shapes.front().pose;
  return s;
}

/// A place to the right of both bodies, where there is room for their difference.
Vec3 place_beside(const std::array<Specimen, 2>& body) {
  const Aabb a = body[0].shape->bounds(body[0].pose()), b = body[1].shape->bounds(body[1].pose());
  if (!a.min.allFinite() || !a.max.allFinite() || !b.min.allFinite() || !b.max.allFinite())
    return Vec3::Zero();
  Aabb both = a, difference{a.min - b.max, a.max - b.min};
  both.include(b);
  difference.include(Vec3(Vec3::Zero()));
  const double gap = 0.35 * both.extent().maxCoeff();
  const Vec3 corner(both.max.x() + gap - difference.min.x(), 0, 0);
  return {corner.x(), both.centre().y() - difference.centre().y(),
          both.centre().z() - difference.centre().z()};
}

bool same(const Pose& a, const Pose& b) {
  return a.x == b.x && a.q.coeffs() == b.q.coeffs();
}
bool same(const Specimen& a, const Specimen& b) {
  return a.name == b.name && a.shape == b.shape && same(a.motion.start, b.motion.start) &&
         a.motion.velocity == b.motion.velocity && a.motion.omega == b.motion.omega &&
         a.motion.t1 == b.motion.t1 && same(a.motion.offset, b.motion.offset);
}

}  // namespace

const std::vector<MicroscopeEntry>& all_microscopes() {
  static const std::vector<MicroscopeEntry> entries = {
      {"gjk", "the simplex of GJK in the difference A - B, and EPA's polytope when they overlap",
       PairMicroscope{refuse_gjk, record_gjk}},
      {"v_clip", "the walk of V-Clip over vertices, edges and faces",
       PairMicroscope{refuse_v_clip, record_v_clip}},
      {"time_of_contact", "the search for the first contact of two moving bodies",
       PairMicroscope{refuse_contact_time, record_contact_time}},
      {"descent", "the way down two trees of boxes to the triangles that are near each other",
       PairMicroscope{refuse_descent, record_aabb_descent}},
      {"descent_obb", "the same with boxes that lie along the triangles",
       PairMicroscope{refuse_descent, record_obb_descent}},
      {"descent_sphere", "the same with spheres",
       PairMicroscope{refuse_descent, record_sphere_descent}},
      {"dantzig", "Dantzig's pivots for the forces of all contacts about a body, without friction",
       WorldMicroscope{refuse_pivots, record_dantzig}},
      {"baraff", "Baraff's pivots for the same forces with friction",
       WorldMicroscope{refuse_pivots, record_baraff}},
      {"first_event", "the event stepper's search for the first event that comes to a body",
       WorldMicroscope{refuse_first_event, record_first_event}},
      {"dfsph", "iterations for the pressures of a fluid",
       WorldMicroscope{refuse_density, record_density}},
  };
  return entries;
}

const MicroscopeEntry* find_microscope(std::string_view name) {
  for (const MicroscopeEntry& entry : all_microscopes())
    if (entry.name == name) return &entry;
  return nullptr;
}

int MicroscopeSetup::step_at(double time) const {
  const double due = std::floor(time * steps_per_second + tolerances::due_step);
  return step + int(std::clamp(due, 0.0, tolerances::most_due_steps));
}

bool MicroscopeSlide::operator==(const MicroscopeSlide& other) const {
  return same(body[0], other.body[0]) && same(body[1], other.body[1]) &&
         tolerance == other.tolerance && beside == other.beside;
}

namespace {

std::string pair_refusal(const Frame& frame, const MicroscopeSetup& setup,
                         const PairMicroscope& microscope) {
  for (size_t i = 0; i < 2; ++i)
    if ((i == 0 ? setup.a : setup.b).is_null())
      return fmt::format("{} looks at two bodies, and body {} is missing", setup.algorithm,
                         i == 0 ? 'A' : 'B');
  if (setup.a == setup.b) return "a body cannot be looked at together with itself";
  const Shape* shapes[2];
  for (size_t i = 0; i < 2; ++i) {
    const BodyInfo* info = find_info(frame, i == 0 ? setup.a : setup.b);
    if (!info) return fmt::format("body {} is gone", i == 0 ? 'A' : 'B');
    if (info->shapes.size() != 1)
      return fmt::format("'{}' has {} shapes; the microscope looks at bodies of one", info->name,
                         info->shapes.size());
    shapes[i] = info->shapes.front().shape.get();
  }
  return microscope.refusal(*shapes[0], *shapes[1]);
}

}  // namespace

std::string microscope_refusal(const Frame& frame, const MicroscopeSetup& setup) {
  const MicroscopeEntry* entry = find_microscope(setup.algorithm);
  if (!entry) {
    std::vector<std::string> known;
    for (const MicroscopeEntry& e : all_microscopes()) known.emplace_back(e.name);
    return unknown_name("algorithm", setup.algorithm, known);
  }
  if (const WorldMicroscope* asks = entry->of_world()) return asks->refusal(frame, setup);
  return pair_refusal(frame, setup, *entry->of_pair());
}

std::shared_ptr<const MicroscopeAnswer> ask_world(const World& world,
                                                  const MicroscopeSetup& setup) {
  const MicroscopeEntry* entry = find_microscope(setup.algorithm);
  if (!entry || !entry->of_world()) return nullptr;
  auto out = std::make_shared<MicroscopeAnswer>();
  out->algorithm = setup.algorithm;
  out->tick = world.tick();
  out->refusal = microscope_refusal(*world.frame(), setup);
  if (!out->refusal.empty()) return out;
  auto recorded = entry->of_world()->record(world, setup);
  if (stop_requested())
    out->refusal = stopped_error().text();
  else if (recorded)
    out->recording = *std::move(recorded);
  else
    out->refusal = recorded.error().text();
  return out;
}

MicroscopeSlide make_slide(const Frame& frame, const std::vector<Pose>& poses,
                           const MicroscopeSetup& setup) {
  MicroscopeSlide slide;
  slide.body = {specimen(frame, poses, setup.a, setup.span),
                specimen(frame, poses, setup.b, setup.span)};
  for (size_t i = 0; i < 2; ++i) {
    Motion& motion = slide.body[i].motion;
    motion.velocity = setup.velocity[i].value_or(motion.velocity);
    motion.omega = setup.angular_velocity[i].value_or(motion.omega);
  }
  slide.tolerance = setup.tolerance;
  slide.beside = setup.beside.value_or(place_beside(slide.body));
  return slide;
}

}  // namespace tumble
