#include "engine/scene/build/jointed_bodies.hpp"

#include "engine/world/world.hpp"

#include <map>
#include <numeric>

namespace tumble {

JointedBodies::JointedBodies(const BuiltScene& built) {
  std::map<uint32_t, uint32_t> place_of;  // index of the body, by slot
  const auto place = [&](BodyId id) {
    const RigidBody* body = built.world->body(id);
    if (!body) return no_body;
    const auto [at, added] = place_of.try_emplace(id.index, uint32_t(bodies.size()));
    if (added) {
      bodies.push_back(*body);
      ids.push_back(id);
      block_of.push_back(body->type == BodyType::fixed ? no_block : at->second);
    }
    return at->second;
  };
  const auto about_centre = [&](const Pose& frame, uint32_t body) -> Pose {
    return {body == no_body ? frame.x : Vec3(frame.x - bodies[body].centre_body),
            frame.q.normalized()};
  };
  std::map<uint32_t, uint32_t> joint_of;  // index of the joint, by slot
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

std::vector<uint32_t> first_numbers(size_t count) {
  std::vector<uint32_t> out(count);
  std::iota(out.begin(), out.end(), 0u);
  return out;
}

}  // namespace tumble
