#include "tests/bench/accuracy/peers.hpp"

#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

namespace tumble::test {
namespace {

std::string numbers(const Vec3& v) {
  return fmt::format("{:.17g} {:.17g} {:.17g}", v.x(), v.y(), v.z());
}
std::string numbers(const Quat& q) {
  return fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}", q.w(), q.x(), q.y(), q.z());
}

/// The scene in MuJoCo's own language: joints make a tree, all else floats.
class SceneText {
 public:
  SceneText(const CaseScene& scene, int hz, const std::string& integrator) : scene_(scene) {
    const size_t n = scene.bodies.size();
    text = fmt::format(
        "<mujoco><compiler angle=\"radian\" boundmass=\"1e-9\" boundinertia=\"1e-12\"/>"
        "<size njmax=\"{}\" nconmax=\"{}\" nstack=\"100000000\"/>"
        "<option timestep=\"{:.17g}\" gravity=\"{}\" integrator=\"{}\"/><worldbody>\n",
        40 * n + 400, 40 * n + 200, 1.0 / hz, numbers(scene.gravity), integrator);
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
    text += fmt::format("<body name=\"b{}\" pos=\"{}\" quat=\"{}\">\n", i, numbers(local.x),
                        numbers(local.q));
    if (!b.fixed) {
      text += fmt::format("<inertial pos=\"0 0 0\" mass=\"{:.17g}\" diaginertia=\"{}\"/>\n", b.mass,
                          numbers(b.inertia));
      if (joint)
        text += fmt::format("<joint type=\"ball\" pos=\"{}\"/>\n",
                            numbers(b.pose.inverse_point(joint->x_world)));
      else
        text += "<freejoint/>\n";
    }
    text += fmt::format("<geom type=\"{}\" size=\"{}\" friction=\"{:.17g} 0.005 0.0001\"{}/>\n",
                        b.radius > 0 ? "sphere" : "box",
                        b.radius > 0 ? fmt::format("{:.17g}", b.radius) : numbers(b.half),
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
    mju_user_warning = [](const char*) {};
    const SceneText scene_text(scene, hz, integrator);
    model_ = load(scene_text.text);
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
    mjtNum v[6];
    mj_objectVelocity(model_, data_, mjOBJ_BODY, ids_[i], v, 0);
    const mjtNum *x = data_->xipos + 3 * ids_[i], *q = data_->xquat + 4 * ids_[i];
    CaseState s;
    s.pose.x = Vec3(x[0], x[1], x[2]);
    s.pose.q = Quat(q[0], q[1], q[2], q[3]);
    s.v = Vec3(v[3], v[4], v[5]);
    s.omega = Vec3(v[0], v[1], v[2]);
    return s;
  }
  void set_force(size_t body, const Vec3& force) override { forces_[body] = force; }
  void set_gravity(const Vec3& gravity) override {
    for (int k = 0; k < 3; ++k) model_->opt.gravity[k] = gravity[k];
  }

 private:
  static mjModel* load(const std::string& text) {
    auto* files = static_cast<mjVFS*>(std::malloc(sizeof(mjVFS)));
    mj_defaultVFS(files);
    mj_makeEmptyFileVFS(files, "case.xml", int(text.size()));
    std::memcpy(files->filedata[mj_findFileVFS(files, "case.xml")], text.data(), text.size());
    char error[1000] = "";
    mjModel* model = mj_loadXML("case.xml", files, error, sizeof error);
    mj_deleteVFS(files);
    std::free(files);
    if (!model) throw std::runtime_error(error);
    return model;
  }

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
