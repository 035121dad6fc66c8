#include "tests/bench/chains/chain.hpp"
#include "tests/bench/peer_values/mujoco.hpp"

namespace tumble::bench {
namespace {

class MujocoChain final : public ChainPeer {
 public:
  explicit MujocoChain(const ChainScene& scene) : scene_(scene) {
    model_ = test::mujoco_model(text());
    model_->opt.timestep = step_seconds;
    model_->opt.integrator = mjINT_RK4;
    model_->opt.gravity[0] = model_->opt.gravity[2] = 0;
    model_->opt.gravity[1] = -gravity;
    model_->opt.disableflags |= mjDSBL_CONTACT;
    data_ = mj_makeData(model_);
    for (int i = 0; i < scene.links; ++i) {
      if (scene.closed) {
        const double half = ring_angle(i) / 2;
        const double turn[] = {std::cos(half), 0, 0, std::sin(half)};
        std::copy(turn, turn + 4, data_->qpos + 4 * i);
      } else {
        data_->qpos[i] = scene.angle(i);
        data_->qvel[i] = scene.rate(i);
      }
    }
    mj_forward(model_, data_);
  }
  ~MujocoChain() override {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  MujocoChain(const MujocoChain&) = delete;
  MujocoChain& operator=(const MujocoChain&) = delete;

  double evaluate() override {
    mj_forward(model_, data_);
    double sum = 0;
    for (int i = 0; i < scene_.links; ++i) {
      const mjtNum* a = data_->qacc + (scene_.closed ? 3 * i : i);
      sum += scene_.closed ? std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) : std::fabs(*a);
    }
    return sum;
  }
  double step() override {
    mj_step(model_, data_);
    return data_->xipos[3 * (model_->nbody - 1) + 1];
  }

 private:
  static std::string mujoco_text(const Axis& v) {
    return test::mujoco_text(Vec3(v[0], v[1], v[2]));
  }
  std::string text() const { return scene_.closed ? ring() : chain(); }
  std::string size() const {
    const int dofs = (scene_.closed ? 3 : 1) * scene_.links;
    return fmt::format("<size njmax=\"16\" nconmax=\"1\" nstack=\"{}\"/>",
                       300 * dofs + 4 * dofs * dofs + 100000);
  }
  /// As URDF, whose bodies are not nested: no more than a hundred can be.
  std::string chain() const {
    const Axis moments = ChainScene::inertia();
    std::string out = "<robot name=\"chain\"><mujoco><compiler fusestatic=\"false\"/>" + size() +
                      "</mujoco><link name=\"ground\"/>\n";
    for (int i = 0; i < scene_.links; ++i) {
      out += fmt::format(
          "<link name=\"b{}\"><inertial><origin xyz=\"{} 0 0\"/><mass value=\"{}\"/>"
          "<inertia ixx=\"{}\" iyy=\"{}\" izz=\"{}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>"
          "</link>\n",
          i, rod_length / 2, rod_mass, moments[0], moments[1], moments[2]);
      out += fmt::format(
          "<joint name=\"j{}\" type=\"continuous\"><parent link=\"{}\"/><child link=\"b{}\"/>"
          "<origin xyz=\"{} 0 0\"/><axis xyz=\"{}\"/></joint>\n",
          i, i == 0 ? "ground" : fmt::format("b{}", i - 1), i, i == 0 ? 0 : rod_length,
          mujoco_text(scene_.axis(i)));
    }
    return out + "</robot>";
  }
  /// Two arms of half the links from the origin, tied at their ends.
  std::string ring() const {
    const int half = scene_.links / 2;
    std::string out = "<mujoco><compiler angle=\"radian\"/>" + size() + "<worldbody>\n";
    for (const int arm : {0, 1}) {
      for (int i = 0; i < half; ++i)
        out += fmt::format(
            "<body name=\"b{}\" pos=\"{} 0 0\"><joint type=\"ball\"/>"
            "<inertial pos=\"{} 0 0\" mass=\"{}\" diaginertia=\"{}\"/>\n",
            arm * half + i, i == 0 ? 0 : rod_length, rod_length / 2, rod_mass,
            mujoco_text(ChainScene::inertia()));
      for (int i = 0; i < half; ++i) out += "</body>";
    }
    return out + fmt::format(
                     "</worldbody><equality><connect body1=\"b{}\" body2=\"b{}\" anchor=\"{} 0 "
                     "0\"/></equality></mujoco>",
                     half - 1, 2 * half - 1, rod_length);
  }
  /// The way round of an arm's link, relative to the one before [rad].
  double ring_angle(int link) const {
    const int half = scene_.links / 2;
    const double angle = scene_.angle(link);
    if (link < half) return angle;
    return link == half ? std::acos(-1.0) : -angle;
  }

  ChainScene scene_;
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
};

}  // namespace

std::unique_ptr<ChainPeer> mujoco_chain(const ChainScene& scene) {
  return std::make_unique<MujocoChain>(scene);
}

}  // namespace tumble::bench
