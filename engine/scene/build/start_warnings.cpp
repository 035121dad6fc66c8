#include "engine/scene/build/start_warnings.hpp"

#include "engine/scene/build/effect_warnings.hpp"
#include "engine/scene/build/joint_starts.hpp"
#include "engine/scene/build/pair_limits.hpp"
#include "engine/scene/build/particle_warnings.hpp"
#include "engine/scene/build/sentences.hpp"
#include "engine/scene/build/spring_limits.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Relative error of a rod's length that is attributed to rounding of the scene's numbers [-].
constexpr double length_slack = 0.01;
/// A body this many times larger than the median is out of proportion ...
constexpr double out_of_proportion = 50;
/// ... if it is also larger than this [m].
constexpr double enormous = 50;

void look_at_rods(const BuiltScene& built, std::vector<std::string>& out) {
  Sentences sentences(out);
  for (const auto& [name, id] : built.joints) {
    const JointDef* def = built.world->joint(id);
    if (!def || def->kind != JointKind::distance) continue;
    const RigidBody *a = built.world->body(def->a), *b = built.world->body(def->b);
    if (!b) continue;
    const Vec3 end_a = a ? a->body_frame().point(def->frame_a.x) : def->frame_a.x;
    const double apart = (b->body_frame().point(def->frame_b.x) - end_a).norm();
    if (std::fabs(apart - def->length) <= length_slack * std::max(apart, def->length)) continue;
    sentences.add(
        fmt::format("joints.{}: length is {:.6g} m, but its ends are {:.6g} m apart at the start, "
                    "which the run "
                    "has to correct (leave out length, or place the bodies to fit)",
                    name, def->length, apart));
  }
}

bool same_point(const Anchor& a, const Anchor& b) {
  if (a.kind != b.kind) return false;
  switch (a.kind) {
    case Anchor::Kind::world:
      return a.point == b.point;
    case Anchor::Kind::body:
      return a.body == b.body && a.point == b.point;
    case Anchor::Kind::particle:
      return a.particles == b.particles && a.particle == b.particle;
  }
  return false;
}

void look_at_springs(const BuiltScene& built, std::vector<std::string>& out) {
  Sentences sentences(out);
  for (const auto& [name, id] : built.forces) {
    const ForceDef* force = built.world->force(id);
    const auto* spring = force ? std::get_if<SpringDef>(force) : nullptr;
    if (spring && same_point(spring->a, spring->b))
      sentences.add(fmt::format(
          "forces.{}: a spring from a point to itself does nothing (give a and b two places)",
          name));
  }
}

/// Properties of a body needed for the checks.
struct Extent {
  const BodyInfo* info;
  Vec3 x;
  double size = 0;  ///< diameter of a bounding ball about the centre of mass [m]
  bool mesh = false;
};

/// A half space that cannot move.
struct Ground {
  std::string name;
  Vec3 x, up;
};

void look_at_bodies(const BuiltScene& built, std::vector<std::string>& out) {
  const auto frame = built.world->frame();
  std::vector<Extent> bodies;
  std::vector<Ground> grounds;
  for (size_t i = 0; i < frame->body_slots(); ++i) {
    const BodyFrame& b = frame->body(i);
    if (b.id == BodyId{}) continue;
    const BodyInfo& info = frame->info(i);
    Extent e{&info, b.pose.x};
    for (const BodyShape& s : info.shapes) {
      if (s.shape->is_half_space()) {
        const Pose at = b.pose * s.pose;
        if (info.type == BodyType::fixed)
          grounds.push_back({info.name, at.x, at.q * Vec3::UnitY()});
      } else {
        e.size = std::max(e.size, 2 * (s.pose.x.norm() + s.shape->bounding_radius()));
        e.mesh = e.mesh || s.shape->is_mesh();
      }
    }
    if (e.size > 0) bodies.push_back(e);
  }
  {
    Sentences sentences(out);
    for (const Extent& e : bodies)
      for (const Ground& g : grounds) {
        const double height = g.up.dot(e.x - g.x);
        if (e.info->type != BodyType::dynamic || !(height < -e.size)) continue;
        sentences.add(fmt::format(
            "bodies.{}: begins {:.4g} m below the surface of '{}', which pushes it out (place it "
            "above)",
            e.info->name, -height, g.name));
      }
  }
  std::vector<double> sizes;
  for (const Extent& e : bodies) sizes.push_back(e.size);
  std::sort(sizes.begin(), sizes.end());
  Sentences sentences(out);
  for (const Extent& e : bodies) {
    // The lower median: of two sizes, the smaller one is the reference.
    const double middle = bodies.size() > 1 ? sizes[(sizes.size() - 1) / 2] : 1;
    if (e.info->type != BodyType::dynamic || e.size < enormous ||
        e.size < out_of_proportion * middle)
      continue;
    sentences.add(
        fmt::format("bodies.{}: is {:.4g} m large, {} ({})", e.info->name, e.size,
                    bodies.size() > 1 ? fmt::format("and the others about {:.3g} m", middle)
                                      : std::string("more than is usual"),
                    e.mesh ? "if its file is in millimetres, give the mesh \"scale\": 0.001"
                           : "lengths are in metres"));
  }
}

}  // namespace

std::vector<std::string> start_warnings(const BuiltScene& built) {
  std::vector<std::string> out;
  if (!built.world) return out;
  look_at_rods(built, out);
  look_at_springs(built, out);
  for (std::string& line : joint_start_warnings(built)) out.push_back(std::move(line));
  for (std::string& line : spring_limit_warnings(built)) out.push_back(std::move(line));
  for (std::string& line : pair_limit_warnings(built)) out.push_back(std::move(line));
  look_at_bodies(built, out);
  for (std::string& line : particle_warnings(built)) out.push_back(std::move(line));
  for (std::string& line : effect_warnings(built)) out.push_back(std::move(line));
  return out;
}

}  // namespace tumble
