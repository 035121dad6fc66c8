#include "tests/bench/chains/chain.hpp"

#include <Simbody.h>

namespace tumble::bench {
namespace {

namespace st = SimTK;

class SimbodyChain final : public ChainPeer {
 public:
  explicit SimbodyChain(const ChainScene& scene)
      : scene_(scene), matter_(system_), forces_(system_) {
    st::Force::UniformGravity(forces_, matter_, st::Vec3(0, -gravity, 0));
    const Axis moments = ChainScene::inertia();
    const st::MassProperties mass(rod_mass, st::Vec3(0),
                                  st::Inertia(moments[0], moments[1], moments[2]));
    const st::Vec3 end(rod_length / 2, 0, 0), begin(-rod_length / 2, 0, 0);
    st::MobilizedBody last = matter_.updGround();
    for (int i = 0; i < scene.links; ++i) {
      const st::Vec3 anchor = i == 0 ? st::Vec3(0) : end;
      const st::Body::Rigid rod(mass);
      if (scene.closed) {
        last = st::MobilizedBody::Ball(last, st::Transform(anchor), rod, st::Transform(begin));
      } else {
        const Axis z = scene.axis(i);
        const st::Rotation turn(st::UnitVec3(z[0], z[1], z[2]), st::ZAxis);
        last = st::MobilizedBody::Pin(last, st::Transform(turn, anchor), rod,
                                      st::Transform(turn, begin));
      }
      rods_.push_back(last);
    }
    if (scene.closed) st::Constraint::Ball(matter_.updGround(), st::Vec3(0), last, end);
    state_ = system_.realizeTopology();
    system_.realizeModel(state_);
    for (int i = 0; i < scene.links; ++i) {
      if (scene.closed) {
        rods_[size_t(i)].setQToFitRotation(state_, st::Rotation(scene.angle(i), st::ZAxis));
      } else {
        rods_[size_t(i)].setOneQ(state_, 0, scene.angle(i));
        rods_[size_t(i)].setOneU(state_, 0, scene.rate(i));
      }
    }
  }

  double evaluate() override {
    state_.invalidateAll(st::Stage::Position);
    system_.realize(state_, st::Stage::Acceleration);
    double sum = 0;
    for (const st::MobilizedBody& rod : rods_) sum += rod.getUDotAsVector(state_).norm();
    return sum;
  }
  double step() override {
    if (!stepper_) {
      integrator_ = std::make_unique<st::RungeKuttaMersonIntegrator>(system_);
      integrator_->setFixedStepSize(step_seconds);
      stepper_ = std::make_unique<st::TimeStepper>(system_, *integrator_);
      stepper_->initialize(state_);
    }
    stepper_->stepTo(++steps_ * step_seconds);
    return rods_.back().getBodyOriginLocation(integrator_->getState())[1];
  }

 private:
  ChainScene scene_;
  st::MultibodySystem system_;
  st::SimbodyMatterSubsystem matter_;
  st::GeneralForceSubsystem forces_;
  std::vector<st::MobilizedBody> rods_;
  st::State state_;
  std::unique_ptr<st::RungeKuttaMersonIntegrator> integrator_;
  std::unique_ptr<st::TimeStepper> stepper_;
  int steps_ = 0;
};

}  // namespace

std::unique_ptr<ChainPeer> simbody_chain(const ChainScene& scene) {
  return std::make_unique<SimbodyChain>(scene);
}

}  // namespace tumble::bench
