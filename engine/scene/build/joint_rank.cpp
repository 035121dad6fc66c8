#include "engine/scene/build/joint_rank.hpp"

#include "engine/dynamics/joints/articulation.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace tumble {
namespace {

/// The joints of a scene, with the bodies that they tie in the order in which they name them.
struct JointedBodies {
  std::vector<RigidBody> bodies;
  std::vector<uint32_t> block_of;
  std::vector<std::string> names;  ///< by joint
  std::vector<Joint> joints;
  std::vector<JointCoupling> couplings;

  explicit JointedBodies(const BuiltScene& built) {
    std::map<uint32_t, uint32_t> place_of;  // by slot
    const auto place = [&](BodyId id) {
      const RigidBody* body = built.world->body(id);
      if (!body) return no_body;
      const auto [at, added] = place_of.try_emplace(id.index, uint32_t(bodies.size()));
      if (added) {
        bodies.push_back(*body);
        block_of.push_back(body->type == BodyType::fixed ? no_block : at->second);
      }
      return at->second;
    };
    const auto about_centre = [&](const Pose& frame, uint32_t body) -> Pose {
      return {body == no_body ? frame.x : Vec3(frame.x - bodies[body].centre_body),
              frame.q.normalized()};
    };
    std::map<uint32_t, uint32_t> joint_of;  // by slot
    for (const auto& [name, id] : built.joints) {
      const JointDef* def = built.world->joint(id);
      if (!def) continue;
      Joint joint;
      joint.kind = def->kind;
      joint.a = place(def->a), joint.b = place(def->b);
      joint.frame_a = about_centre(def->frame_a, joint.a);
      joint.frame_b = about_centre(def->frame_b, joint.b);
      joint.length = def->length;
      joint.drives = std::make_shared<JointDrives>(def->drives);
      follow_coordinates(joint, bodies, 0);
      joint_of.emplace(id.index, uint32_t(joints.size()));
      joints.push_back(std::move(joint));
      names.push_back(name);
    }
    for (const auto& [name, id] : built.joints) {
      const auto follower = joint_of.find(id.index);
      if (follower == joint_of.end()) continue;
      const JointDrives& drives = *joints[follower->second].drives;
      for (uint32_t k = 0; k < most_coordinates; ++k) {
        if (!drives[k].couple) continue;
        const JointId other = drives[k].couple->joint;
        const auto leader = other.is_null() ? follower : joint_of.find(other.index);
        if (leader == joint_of.end()) continue;
        couplings.push_back({follower->second, leader->second, k, drives[k].couple->coordinate,
                             drives[k].couple->ratio, drives[k].couple->offset});
      }
    }
  }
};

std::vector<uint32_t> all_of(size_t count) {
  std::vector<uint32_t> out(count);
  std::iota(out.begin(), out.end(), 0u);
  return out;
}

}  // namespace

JointRank joint_rank(const BuiltScene& built) {
  JointRank out;
  if (built.joints.empty()) return out;
  const JointedBodies held(built);
  const std::vector<uint32_t> slots = all_of(held.bodies.size()),
                              joints = all_of(held.joints.size()),
                              couplings = all_of(held.couplings.size());
  Articulation rows({held.joints, held.couplings}, {joints, couplings}, held.block_of, held.bodies,
                    held.bodies.size());
  rows.update(held.bodies, blocks_of(held.bodies, slots));
  std::map<uint32_t, size_t> dependent;  // by joint
  for (size_t i = 0; i < rows.size(); ++i) {
    const HeldRow& row = rows.held()[i];
    if (row.use == RowUse::armature) continue;
    ++out.rows;
    if (!rows.depends(i))
      ++out.rank;
    else
      ++dependent[row.use == RowUse::coupling ? held.couplings[row.owner].a : row.owner];
  }
  for (const auto& [joint, count] : dependent) out.dependent.emplace_back(held.names[joint], count);
  return out;
}

std::string text_of(const JointRank& rank) {
  constexpr size_t most = 5;
  if (rank.rows == 0) return {};
  std::string out = fmt::format("joint rows: {}, rank {}", rank.rows, rank.rank);
  for (size_t i = 0; i < std::min(most, rank.dependent.size()); ++i)
    out += fmt::format("{} {} of '{}'", i == 0 ? ", dependent:" : ",", rank.dependent[i].second,
                       rank.dependent[i].first);
  if (rank.dependent.size() > most)
    out += fmt::format(" and those of {} more", rank.dependent.size() - most);
  return out;
}

}  // namespace tumble
