#include "engine/scene/robot_files/followers.hpp"

#include "engine/core/text.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace tumble {
namespace {

using JointsByName = std::map<std::string, RobotJoint*>;

JointsByName joints_of(RobotModel& model) {
  JointsByName out;
  for (RobotLink& link : model.links)
    for (RobotJoint& joint : link.joints)
      if (!joint.name.empty()) out.emplace(joint.name, &joint);
  return out;
}

/// Removes the coupling of a joint that cannot follow; `why` ends the sentence of the warning.
void let_go(RobotJoint& joint, const std::string& why, RobotLog& log) {
  log.warn(joint.at, fmt::format("joint '{}' does not follow '{}', it moves by itself: {}",
                                 joint.name, joint.mimic->joint, why));
  joint.mimic.reset();
}

void check_one(RobotJoint& joint, const JointsByName& all, RobotLog& log) {
  const auto leader = all.find(joint.mimic->joint);
  if (leader == all.end()) {
    std::vector<std::string> names;
    for (const auto& item : all) names.push_back(item.first);
    return let_go(joint, unknown_name("joint", joint.mimic->joint, names), log);
  }
  for (const RobotJoint* end : {&joint, leader->second})
    if (end->kind == RobotJoint::Kind::ball)
      return let_go(joint, "a ball joint has no coordinate of its own", log);
}

/// Sets the coordinate at the start from that of its leader; true if the chain of leaders ends.
bool set_start_of(RobotJoint& joint, const JointsByName& all, size_t depth) {
  if (!joint.mimic) return true;
  if (depth > all.size()) return false;
  RobotJoint& leader = *all.at(joint.mimic->joint);
  if (!set_start_of(leader, all, depth + 1)) return false;
  joint.start = joint.mimic->multiplier * leader.start + joint.mimic->offset;
  return true;
}

/// The drive of the joint that has this coordinate.
DriveDescription& drive_at(const RobotFollowers::Place& place,
                           NamedList<JointDescription>& joints) {
  JointDescription& joint = std::ranges::find(joints.items, place.joint, [](const auto& item) {
                              return item.name;
                            })->value;
  DriveDescription* out = &joint.drive;
  JointDescription::for_drives(joint, [&](std::string_view name, auto& drive) {
    if (name != place.coordinate) return;
    if (!drive) drive.emplace();
    out = &*drive;
  });
  return *out;
}

}  // namespace

void start_followers(RobotModel& model, RobotLog& log) {
  const JointsByName all = joints_of(model);
  for (RobotLink& link : model.links)
    for (RobotJoint& joint : link.joints)
      if (joint.mimic) check_one(joint, all, log);
  for (RobotLink& link : model.links)
    for (RobotJoint& joint : link.joints)
      if (joint.mimic && !set_start_of(joint, all, 0))
        let_go(joint, "they follow each other in a circle", log);
}

void RobotFollowers::put(const RobotJoint& joint, Place place) {
  if (joint.mimic) followers_.push_back({joint, place});
  if (!joint.name.empty()) places_.emplace(joint.name, std::move(place));
}

void RobotFollowers::couple(NamedList<JointDescription>& joints, RobotLog& log) const {
  for (const Follower& f : followers_) {
    const RobotMimic& mimic = *f.joint.mimic;
    const auto leader = places_.find(mimic.joint);
    if (leader == places_.end()) {
      log.warn(f.joint.at, fmt::format("joint '{}' does not follow '{}', which does not move: it "
                                       "moves by itself",
                                       f.joint.name, mimic.joint));
      continue;
    }
    CoupleDescription& couple = drive_at(f.place, joints).couple.emplace();
    couple.joint = leader->second.joint;
    couple.coordinate = leader->second.coordinate;
    couple.ratio = mimic.multiplier;
    const double offset = mimic.offset + mimic.multiplier * leader->second.zero - f.place.zero;
    if (offset == 0) continue;
    if (f.joint.kind == RobotJoint::Kind::hinge)
      couple.offset_deg = offset * 180 / std::numbers::pi;
    else
      couple.offset = offset;
  }
}

}  // namespace tumble
