#include "tests/bench/accuracy/peers.hpp"
#include "tests/bench/peer_values/mujoco.hpp"

namespace tumble::test {
namespace {

/// The scene in MuJoCo's own language: joints make a tree, all else floats.
class SceneText {
 public:
  SceneText(const CaseScene& scene, int hz, const std::string& integrator) : scene_(scene) {
    const size_t n = scene.bodies.size();
    text = fmt::format(
        "<mujoco><compiler angle=\"radian\" boundmass=\"1e-9\" boundinertia=\"1e-12\"/>"
        "<size njmax=\"{}\" nconmax=\"{}\" nstack=\"100000000\"/>"
        "<option timestep=\"{:.17g}\" gravity=\"{}\" integrator=\"{}\"/><worldbody>\n",
        40 * n + 400, 40 * n + 200, 1.0 / hz, mujoco_text(scene.gravity), integrator);
    for (size_t i = 0; i < n; ++i) {
      const CaseJoint* j = joint_of(i);
      if (!j || j->a < 0) add(i, Pose{}, j);
    }
    text += "</worldbody></mujoco>";
  }
  const CaseJoint* joint_of(size_t body) const {
    for (const CaseJoint& j : scene_.joints)
      if (size_t(j.b) == body) return &j;
    return nullptr;
  }
  std::string text;

 private:
  void add(size_t i, const Pose& parent, const CaseJoint* joint) {
    const CaseBody& b = scene_.bodies[i];
    const Pose local = parent.inverse() * b.pose;
    text += fmt::format("<body name=\"b{}\" pos=\"{}\" quat=\"{}\">\n", i, mujoco_text(local.x),
                        mujoco_text(local.q));
    if (!b.fixed) {
      text += fmt::format("<inertial pos=\"0 0 0\" mass=\"{:.17g}\" diaginertia=\"{}\"/>\n", b.mass,
                          mujoco_text(b.inertia));
      if (joint)
        text += fmt::format("<joint type=\"ball\" pos=\"{}\"/>\n",
                            mujoco_text(b.pose.inverse_point(joint->x_world)));
      else
        text += "<freejoint/>\n";
    }
    text += fmt::format("<geom type=\"{}\" size=\"{}\" friction=\"{:.17g} 0.005 0.0001\"{}/>\n",
                        b.radius > 0 ? "sphere" : "box",
                        b.radius > 0 ? fmt::format("{:.17g}", b.radius) : mujoco_text(b.half),
                        b.friction_largest >= 0 ? b.friction_largest : b.friction,
                        scene_.collide ? "" : " contype=\"0\" conaffinity=\"0\"");
    for (const CaseJoint& j : scene_.joints)
      if (j.a == int(i)) add(size_t(j.b), b.pose, &j);
    text += "</body>\n";
  }
  const CaseScene& scene_;
};

class MujocoCase final : public CaseWorld {
 public:
  MujocoCase(const CaseScene& scene, int hz, const std::string& integrator)
      : forces_(scene.bodies.size(), Vec3::Zero()) {
    const SceneText scene_text(scene, hz, integrator);
    model_ = mujoco_model(scene_text.text);
    data_ = mj_makeData(model_);
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
      const int id = mj_name2id(model_, mjOBJ_BODY, fmt::format("b{}", i).c_str());
      ids_.push_back(id);
      const CaseBody& b = scene.bodies[i];
      if (b.fixed || scene_text.joint_of(i)) continue;
      const int at = model_->jnt_dofadr[model_->body_jntadr[id]];
      const Vec3 turn = b.pose.inverse_direction(b.omega);
      for (int k = 0; k < 3; ++k) data_->qvel[at + k] = b.v[k], data_->qvel[at + 3 + k] = turn[k];
    }
    mj_forward(model_, data_);
  }
  ~MujocoCase() override {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  void step() override {
    for (size_t i = 0; i < forces_.size(); ++i)
      for (int k = 0; k < 3; ++k) data_->xfrc_applied[6 * ids_[i] + k] = forces_[i][k];
    mj_step(model_, data_);
    mj_kinematics(model_, data_);
    mj_comPos(model_, data_);
    mj_comVel(model_, data_);
  }
  CaseState state(size_t i) override {
    CaseState s;
    read_mujoco_body(model_, data_, ids_[i], s.pose, s.v, s.omega);
    return s;
  }
  void set_force(size_t body, const Vec3& force) override { forces_[body] = force; }
  void set_gravity(const Vec3& gravity) override {
    for (int k = 0; k < 3; ++k) model_->opt.gravity[k] = gravity[k];
  }

 private:
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
  std::vector<int> ids_;
  std::vector<Vec3> forces_;
};

}  // namespace

CaseMaker mujoco_maker(std::string integrator) {
  return [integrator](const CaseScene& scene, int hz) {
    return std::make_unique<MujocoCase>(scene, hz, integrator);
  };
}

}  // namespace tumble::test
