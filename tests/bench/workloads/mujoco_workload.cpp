#include "engine/collision/shapes/convex_hull.hpp"
#include "engine/math/rotation.hpp"
#include "tests/bench/peer_values/mujoco.hpp"
#include "tests/bench/workloads/peers.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace tumble::test {
namespace {

size_t moving_count(const PeerScene& scene) {
  return size_t(std::count_if(scene.bodies.begin(), scene.bodies.end(),
                              [](const RigidBody& b) { return b.dynamic(); }));
}

/// The scene in MuJoCo's own language: a tree of bodies where the joints make one, else free
/// bodies and equalities.
class WorkloadText {
 public:
  explicit WorkloadText(const PeerScene& scene)
      : scene_(scene), parent_(scene.bodies.size()), children_(scene.bodies.size()) {
    tree_ = find_tree();
    const size_t moving = moving_count(scene);
    const size_t rows = 4 * (10 * moving + 100) + 3 * scene.workload.joints.size();
    text_ = fmt::format(
        "<mujoco><compiler angle=\"radian\" boundmass=\"1e-9\" boundinertia=\"1e-12\"/>"
        "<size njmax=\"{}\" nconmax=\"{}\" nstack=\"100000000\"/>"
        "<option timestep=\"{:.17g}\" gravity=\"0 -9.81 0\"/>\n",
        rows, 40 * moving + 200, PeerScene::step);
    add_hulls();
    text_ += "<worldbody>\n";
    for (size_t i = 0; i < scene.bodies.size(); ++i)
      if (!parent_[i]) add_body(i, Pose{});
    text_ += "</worldbody>\n<contact>\n";
    if (scene.workload.collides) add_groups();
    text_ += "</contact>\n<equality>\n";
    if (!tree_) add_equalities();
    text_ += "</equality></mujoco>\n";
  }
  const std::string& text() const { return text_; }

 private:
  /// Every body at most once the second of a joint.
  bool find_tree() {
    for (const WorkloadJoint& j : scene_.workload.joints) {
      if (parent_[j.b]) {
        std::fill(parent_.begin(), parent_.end(), nullptr);
        for (auto& c : children_) c.clear();
        return false;
      }
      parent_[j.b] = &j;
      children_[j.a].push_back(j.b);
    }
    return true;
  }
  void add_hulls() {
    text_ += "<asset>\n";
    for (const RigidBody& b : scene_.bodies) {
      for (const BodyShape& s : b.shapes) {
        const auto* hull = dynamic_cast<const ConvexHullShape*>(s.shape.get());
        if (!hull || !hulls_.try_emplace(s.shape->def().mesh.get(), hulls_.size()).second) continue;
        text_ += fmt::format("<mesh name=\"h{}\" vertex=\"", hulls_.size() - 1);
        for (const Vec3& v : hull->polyhedron().vertices) text_ += mujoco_text(v) + " ";
        text_ += "\"/>\n";
      }
    }
    text_ += "</asset>\n";
  }
  std::string kind_and_size(const ShapeDef& def) const {
    switch (def.type) {
      case ShapeType::sphere:
        return fmt::format("type=\"sphere\" size=\"{:.17g}\"", def.radius);
      case ShapeType::capsule:
        return fmt::format("type=\"capsule\" size=\"{:.17g} {:.17g}\"", def.radius,
                           0.5 * def.height);
      case ShapeType::box:
        return fmt::format("type=\"box\" size=\"{}\"", mujoco_text(def.half_extents));
      default:
        return fmt::format("type=\"mesh\" mesh=\"h{}\"", hulls_.at(def.mesh.get()));
    }
  }
  void add_shape(const BodyShape& s) {
    Quat q = s.pose.q;
    if (s.shape->type() == ShapeType::capsule)  // its capsules lie along z
      q = q * axis_angle(Vec3::UnitX(), M_PI / 2);
    text_ += fmt::format("<geom {} friction=\"{:.17g} 0.005 0.0001\"{} pos=\"{}\" quat=\"{}\"/>\n",
                         kind_and_size(s.shape->def()), s.material.friction,
                         scene_.workload.collides ? "" : " contype=\"0\" conaffinity=\"0\"",
                         mujoco_text(s.pose.x), mujoco_text(q));
  }
  std::string joint_text(size_t i) const {
    const RigidBody& b = scene_.bodies[i];
    if (b.type == BodyType::kinematic)  // so heavy that nothing slows it
      return "<joint type=\"hinge\" axis=\"0 0 1\" armature=\"1e9\" damping=\"0\"/>\n";
    if (!parent_[i]) return "<freejoint/>\n";
    const WorkloadJoint& j = *parent_[i];
    return fmt::format(
        "<joint type=\"{}\" pos=\"{}\" axis=\"{}\"/>\n",
        j.kind == JointKind::spherical ? "ball" : "hinge",
        mujoco_text(b.pose.inverse_point(j.frame.x)),
        mujoco_text(Vec3(b.pose.inverse_direction(j.frame.direction(Vec3::UnitZ())))));
  }
  void add_body(size_t i, const Pose& parent) {
    const RigidBody& b = scene_.bodies[i];
    const Pose local = parent.inverse() * b.pose;
    text_ += fmt::format("<body name=\"b{}\" pos=\"{}\" quat=\"{}\">\n", i, mujoco_text(local.x),
                         mujoco_text(local.q));
    if (b.type != BodyType::fixed) {
      const Vec3 inertia = b.dynamic() ? Vec3(b.inertia_body.diagonal()) : Vec3::Constant(1e9);
      text_ += fmt::format("<inertial pos=\"0 0 0\" mass=\"{:.17g}\" diaginertia=\"{}\"/>\n",
                           b.dynamic() ? b.mass : 1e7, mujoco_text(inertia));
      text_ += joint_text(i);
    }
    for (const BodyShape& s : b.shapes) add_shape(s);
    for (const size_t child : children_[i]) add_body(child, b.pose);
    text_ += "</body>\n";
  }
  void add_groups() {
    for (size_t i = 0; i < scene_.bodies.size(); ++i)
      for (size_t j = i + 1; j < scene_.bodies.size(); ++j)
        if (scene_.bodies[i].group != 0 && scene_.bodies[i].group == scene_.bodies[j].group)
          text_ += fmt::format("<exclude body1=\"b{}\" body2=\"b{}\"/>\n", i, j);
  }
  void add_equalities() {
    for (const WorkloadJoint& j : scene_.workload.joints)
      text_ += fmt::format("<connect body1=\"b{}\" body2=\"b{}\" anchor=\"{}\"/>\n", j.b, j.a,
                           mujoco_text(scene_.bodies[j.b].pose.inverse_point(j.frame.x)));
  }

  const PeerScene& scene_;
  std::vector<const WorkloadJoint*> parent_;  ///< by body; null: none
  std::vector<std::vector<size_t>> children_;
  std::map<const TriangleMesh*, size_t> hulls_;
  bool tree_ = false;
  std::string text_;
};

class MujocoWorkload final : public WorkloadPeer {
 public:
  explicit MujocoWorkload(const PeerScene& scene)
      : model_(mujoco_model(WorkloadText(scene).text())), data_(mj_makeData(model_)) {
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
      const int id = mj_name2id(model_, mjOBJ_BODY, fmt::format("b{}", i).c_str());
      ids_.push_back(id);
      if (scene.bodies[i].type == BodyType::kinematic)
        turning_.push_back(
            {model_->jnt_dofadr[model_->body_jntadr[id]], scene.bodies[i].omega.z()});
    }
    mj_forward(model_, data_);
  }
  ~MujocoWorkload() override {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  void step() override {
    for (const auto& [at, rate] : turning_) data_->qvel[at] = rate;
    mj_step(model_, data_);
  }
  void read(std::span<RigidBody> bodies) override {
    mj_kinematics(model_, data_);
    mj_comPos(model_, data_);
    mj_comVel(model_, data_);
    for (size_t i = 0; i < bodies.size(); ++i)
      read_mujoco_body(model_, data_, ids_[i], bodies[i].pose, bodies[i].v, bodies[i].omega);
  }
  size_t contact_points() const override { return size_t(data_->ncon); }

 private:
  mjModel* model_;
  mjData* data_;
  std::vector<int> ids_;
  std::vector<std::pair<int, double>> turning_;  ///< degree of freedom, rate [rad/s]
};

}  // namespace

std::unique_ptr<WorkloadPeer> mujoco_workload(const PeerScene& scene) {
  const bool meshes = scene.workload.tori.has_value();
  if (meshes || moving_count(scene) > 150) return nullptr;
  return std::make_unique<MujocoWorkload>(scene);
}

}  // namespace tumble::test
