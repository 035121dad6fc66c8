#include "engine/scene/robot_files/robot_bodies.hpp"

#include <array>

#include <fmt/format.h>

namespace tumble {
namespace {

void append(std::vector<RobotGeometry>& to, const std::vector<RobotGeometry>& from,
            const Pose& pose) {
  for (RobotGeometry g : from) {
    g.pose = pose * g.pose;
    to.push_back(std::move(g));
  }
}

/// Adds the geometry and mass of `part` to a body, where `pose` places the part in the body's
/// frame.
void add_to(RobotBody& to, const RobotBody& part, const Pose& pose) {
  append(to.collides, part.collides, pose);
  append(to.drawn, part.drawn, pose);
  if (!(part.mass.mass > 0)) return;
  const MassProperties at = moved(part.mass, pose);
  to.mass = to.mass.mass > 0 ? compound(std::array{to.mass, at}) : at;
}

Pose moved_by(const std::vector<RobotJoint>& joints) {
  Pose out;
  for (const RobotJoint& joint : joints) out = out * displacement(joint);
  return out;
}

class Joiner {
 public:
  Joiner(const RobotModel& model, RobotBase base, RobotLog& log)
      : model_(model), base_(base), log_(log) {}

  RobotBodies take() {
    for (size_t i = 0; i < model_.links.size(); ++i) add(i);
    for (size_t b = 0; b < out_.bodies.size(); ++b)
      if (!gone_[b] && !(out_.bodies[b].mass.mass > 0)) join_massless(b);
    renumber();
    place();
    return std::move(out_);
  }

 private:
  void add(size_t index) {
    const RobotLink& link = model_.links[index];
    const LinkPlace parent =
        link.parent == RobotLink::world ? LinkPlace{} : out_.links[link.parent];
    RobotBody made{link.name,
                   link.at,
                   link.mass,
                   link.collides,
                   link.drawn,
                   parent.body,
                   parent.in_body * link.in_parent,
                   link.joints,
                   link.floating,
                   false,
                   {}};
    if (link.joints.empty() && !link.floating && link.parent != RobotLink::world) {
      add_to(out_.bodies[parent.body], made, made.in_parent);
      out_.links.push_back({parent.body, made.in_parent});
      return;
    }
    if (link.joints.empty() && link.parent == RobotLink::world) {
      made.floating = base_ == RobotBase::floating || (link.floating && base_ == RobotBase::file);
      made.fixed = !made.floating;
    }
    out_.links.push_back({out_.bodies.size(), {}});
    out_.bodies.push_back(std::move(made));
    gone_.push_back(false);
  }

  /// Handles a body without mass, by what is attached to it.
  void join_massless(size_t b) {
    RobotBody& body = out_.bodies[b];
    if (body.fixed) return;
    if (body.floating) {
      if (body.parent == RobotLink::world) {
        log_.warn(body.at,
                  fmt::format("'{}' has no mass and cannot move freely: it is fixed", body.name));
        body.floating = false;
        body.fixed = true;
      } else {
        weld(b);
      }
      return;
    }
    std::vector<size_t> hanging;
    for (size_t c = b + 1; c < out_.bodies.size(); ++c)
      if (!gone_[c] && out_.bodies[c].parent == b) hanging.push_back(c);
    if (hanging.size() == 1 && !out_.bodies[hanging[0]].joints.empty())
      hand_on(b, hanging[0]);
    else
      weld(b);
  }

  /// Puts the joints of b before those of c, in the frame of c.
  void hand_on(size_t b, size_t c) {
    RobotBody& body = out_.bodies[b];
    RobotBody& child = out_.bodies[c];
    const Pose from_body = child.in_parent.inverse();
    std::vector<RobotJoint> joints = body.joints;
    for (RobotJoint& joint : joints) {
      joint.anchor = from_body.point(joint.anchor);
      joint.axis = from_body.direction(joint.axis);
    }
    const Pose in_child = (child.in_parent * moved_by(child.joints)).inverse();
    joints.insert(joints.end(), child.joints.begin(), child.joints.end());
    child.joints = std::move(joints);
    child.in_parent = body.in_parent * child.in_parent;
    child.parent = body.parent;
    add_to(child, body, in_child);
    leave(b, {c, in_child});
  }

  void weld(size_t b) {
    RobotBody& body = out_.bodies[b];
    std::string names;
    for (const RobotJoint& joint : body.joints) names += (names.empty() ? "" : ", ") + joint.name;
    log_.warn(body.at,
              fmt::format("'{}' has no mass: it is welded to what it hangs on{}", body.name,
                          names.empty() ? "" : ", and " + names + " cannot move"));
    const Pose pose = body.in_parent * moved_by(body.joints);
    if (body.parent == RobotLink::world) {
      body.in_parent = pose;
      body.joints.clear();
      body.floating = false;
      body.fixed = true;
      return;
    }
    add_to(out_.bodies[body.parent], body, pose);
    for (size_t c = b + 1; c < out_.bodies.size(); ++c) {
      if (gone_[c] || out_.bodies[c].parent != b) continue;
      out_.bodies[c].parent = body.parent;
      out_.bodies[c].in_parent = pose * out_.bodies[c].in_parent;
    }
    leave(b, {body.parent, pose});
  }

  void leave(size_t b, const LinkPlace& now) {
    gone_[b] = true;
    for (LinkPlace& l : out_.links)
      if (l.body == b) l = {now.body, now.in_body * l.in_body};
  }

  void renumber() {
    std::vector<size_t> place(out_.bodies.size(), RobotLink::world);
    std::vector<RobotBody> kept;
    for (size_t b = 0; b < out_.bodies.size(); ++b) {
      if (gone_[b]) continue;
      place[b] = kept.size();
      kept.push_back(std::move(out_.bodies[b]));
    }
    for (RobotBody& body : kept)
      if (body.parent != RobotLink::world) body.parent = place[body.parent];
    for (LinkPlace& l : out_.links)
      if (l.body != RobotLink::world) l.body = place[l.body];
    out_.bodies = std::move(kept);
  }

  void place() {
    for (RobotBody& body : out_.bodies) {
      const Pose parent = body.parent == RobotLink::world ? Pose{} : out_.bodies[body.parent].start;
      body.start = parent * body.in_parent * moved_by(body.joints);
      body.start.q.normalize();
    }
  }

  const RobotModel& model_;
  RobotBase base_;
  RobotLog& log_;
  RobotBodies out_;
  std::vector<bool> gone_;
};

}  // namespace

RobotBodies join_welded(const RobotModel& model, RobotBase base, RobotLog& log) {
  return Joiner(model, base, log).take();
}

}  // namespace tumble
