#include "engine/math/dense.hpp"
#include "tests/bench/peer_values/mujoco.hpp"
#include "tests/bench/trees/tree.hpp"

#include <cmath>

namespace tumble::bench {
namespace {

class MujocoTree final : public TreePeer {
 public:
  explicit MujocoTree(const TreeScene& scene) : scene_(scene), model_(test::mujoco_model(text())) {
    model_->opt.timestep = scene.step;
    model_->opt.integrator = mjINT_RK4;
    for (int k = 0; k < 3; ++k) model_->opt.gravity[k] = scene.gravity[k];
    model_->opt.disableflags |= mjDSBL_CONTACT;
    data_ = mj_makeData(model_);
    for (size_t i = 0; i < scene.links.size(); ++i) {
      if (scene.links[i].free) continue;
      const int joint = mj_name2id(model_, mjOBJ_JOINT, fmt::format("j{}", i).c_str());
      data_->qpos[model_->jnt_qposadr[joint]] = scene.links[i].angle;
      data_->qvel[model_->jnt_dofadr[joint]] = scene.links[i].rate;
      hinges_.push_back(model_->jnt_dofadr[joint]);
    }
    tip_ = mj_name2id(model_, mjOBJ_BODY, fmt::format("b{}", scene.links.size() - 1).c_str());
    mj_forward(model_, data_);
  }
  ~MujocoTree() override {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  MujocoTree(const MujocoTree&) = delete;
  MujocoTree& operator=(const MujocoTree&) = delete;

  double evaluate() override {
    mj_forward(model_, data_);
    double sum = 0;
    for (const int hinge : hinges_) sum += std::fabs(data_->qacc[hinge]);
    return sum;
  }
  double step() override {
    mj_step(model_, data_);
    const mjtNum* x = data_->xipos + 3 * tip_;
    return scene_.height({x[0], x[1], x[2]});
  }

 private:
  std::string body(size_t i) const {
    const TreeLink& link = scene_.links[i];
    const Mat3 m = small_matrix(link.inertia);
    std::string out = fmt::format("<body name=\"b{}\" pos=\"{}\" quat=\"{}\">", i,
                                  test::mujoco_text(small_vector(link.in_parent.translation())),
                                  test::mujoco_text(Quat(small_matrix(link.in_parent.linear()))));
    out += link.free ? "<freejoint/>"
                     : fmt::format("<joint name=\"j{}\" axis=\"{}\"/>", i,
                                   test::mujoco_text(small_vector(link.axis)));
    out += fmt::format("<inertial pos=\"{}\" mass=\"{:.17g}\" fullinertia=\"{} {}\"/>\n",
                       test::mujoco_text(small_vector(link.centre)), link.mass,
                       test::mujoco_text(Vec3(m.diagonal())),
                       test::mujoco_text(Vec3(m(0, 1), m(0, 2), m(1, 2))));
    return out + children(int(i)) + "</body>\n";
  }
  std::string children(int parent) const {
    std::string out;
    for (size_t i = 0; i < scene_.links.size(); ++i)
      if (scene_.links[i].parent == parent) out += body(i);
    return out;
  }
  std::string text() const {
    return "<mujoco><compiler angle=\"radian\"/><worldbody>" + children(-1) +
           "</worldbody></mujoco>";
  }

  TreeScene scene_;
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
  std::vector<int> hinges_;
  int tip_ = 0;
};

}  // namespace

std::unique_ptr<TreePeer> mujoco_tree(const TreeScene& scene) {
  return std::make_unique<MujocoTree>(scene);
}

}  // namespace tumble::bench
