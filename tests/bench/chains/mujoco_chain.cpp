#include "tests/bench/chains/chain.hpp"
#include "tests/bench/peer_values/mujoco.hpp"

namespace tumble::bench {
namespace {

class MujocoChain final : public ChainPeer {
 public:
  explicit MujocoChain(const ChainScene& scene) : scene_(scene) {
    model_ = test::mujoco_model(text());
    data_ = mj_makeData(model_);
    for (int i = 0; i < scene.links; ++i) {
      if (scene.closed) {
        const double half = scene.angle(i) / 2;
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
    return data_->xipos[3 * scene_.links + 1];
  }

 private:
  static std::string mujoco_text(const Axis& v) {
    return test::mujoco_text(Vec3(v[0], v[1], v[2]));
  }
  std::string text() const {
    const int n = scene_.links;
    std::string out = fmt::format(
        "<mujoco><compiler angle=\"radian\"/><size njmax=\"{}\" nconmax=\"1\" nstack=\"{}\"/>"
        "<option timestep=\"{}\" gravity=\"0 {} 0\" integrator=\"RK4\" tolerance=\"0\">"
        "<flag contact=\"disable\"/></option><worldbody>\n",
        16, 300 * n + 4 * n * n + 100000, step_seconds, -gravity);
    for (int i = 0; i < n; ++i) {
      const std::string kind =
          scene_.closed ? "ball\"" : "hinge\" axis=\"" + mujoco_text(scene_.axis(i)) + '"';
      out += fmt::format(
          "<body name=\"b{}\" pos=\"{} 0 0\"><joint type=\"{}/>"
          "<inertial pos=\"{} 0 0\" mass=\"{}\" diaginertia=\"{}\"/>\n",
          i, i == 0 ? 0 : rod_length, kind, rod_length / 2, rod_mass,
          mujoco_text(ChainScene::inertia()));
    }
    for (int i = 0; i < n; ++i) out += "</body>";
    out += "</worldbody>";
    if (scene_.closed)
      out += fmt::format("<equality><connect body1=\"b{}\" anchor=\"{} 0 0\"/></equality>", n - 1,
                         rod_length);
    return out + "</mujoco>";
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
