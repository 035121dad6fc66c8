#include "tests/bench/trees/tree.hpp"

#include <cmath>

#include <Simbody.h>

namespace tumble::bench {
namespace {

namespace st = SimTK;

st::Vec3 vector(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
st::Transform transform(const Eigen::Isometry3d& t) {
  st::Mat33 turn;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) turn(i, k) = t.linear()(i, k);
  return {st::Rotation(turn), vector(t.translation())};
}

class SimbodyTree final : public TreePeer {
 public:
  explicit SimbodyTree(const TreeScene& scene) : scene_(scene), matter_(system_), forces_(system_) {
    st::Force::UniformGravity(forces_, matter_, vector(scene.gravity));
    for (const TreeLink& link : scene.links) add(link);
    state_ = system_.realizeTopology();
    system_.realizeModel(state_);
    for (size_t i = 0; i < scene.links.size(); ++i) {
      const TreeLink& link = scene.links[i];
      if (link.free) continue;
      bodies_[i].setOneQ(state_, 0, link.angle);
      bodies_[i].setOneU(state_, 0, link.rate);
      hinges_.push_back(bodies_[i]);
    }
  }

  double evaluate() override {
    state_.invalidateAll(st::Stage::Position);
    system_.realize(state_, st::Stage::Acceleration);
    double sum = 0;
    for (const st::MobilizedBody& hinge : hinges_) sum += std::fabs(hinge.getOneUDot(state_, 0));
    return sum;
  }
  double step() override {
    if (!stepper_) {
      integrator_ = std::make_unique<st::RungeKuttaMersonIntegrator>(system_);
      integrator_->setFixedStepSize(scene_.step);
      stepper_ = std::make_unique<st::TimeStepper>(system_, *integrator_);
      stepper_->initialize(state_);
    }
    stepper_->stepTo(++steps_ * scene_.step);
    const st::Vec3 x = bodies_.back().findMassCenterLocationInGround(integrator_->getState());
    return scene_.height({x[0], x[1], x[2]});
  }

 private:
  void add(const TreeLink& link) {
    st::MobilizedBody parent =
        link.parent < 0 ? st::MobilizedBody(matter_.updGround()) : bodies_[size_t(link.parent)];
    const Eigen::Matrix3d& about_centre = link.inertia;
    const Eigen::Vector3d& c = link.centre;
    const Eigen::Matrix3d i =
        about_centre +
        link.mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
    const st::MassProperties mass(
        link.mass, vector(c), st::Inertia(i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2)));
    const st::Body::Rigid body(mass);
    const st::Transform in_parent = transform(link.in_parent);
    if (link.free) {
      bodies_.push_back(st::MobilizedBody::Free(parent, in_parent, body, st::Transform()));
      return;
    }
    const st::Rotation turn(st::UnitVec3(vector(link.axis)), st::ZAxis);
    bodies_.push_back(
        st::MobilizedBody::Pin(parent, in_parent * st::Transform(turn), body, st::Transform(turn)));
  }

  TreeScene scene_;
  st::MultibodySystem system_;
  st::SimbodyMatterSubsystem matter_;
  st::GeneralForceSubsystem forces_;
  std::vector<st::MobilizedBody> bodies_, hinges_;
  st::State state_;
  std::unique_ptr<st::RungeKuttaMersonIntegrator> integrator_;
  std::unique_ptr<st::TimeStepper> stepper_;
  int steps_ = 0;
};

}  // namespace

std::unique_ptr<TreePeer> simbody_tree(const TreeScene& scene) {
  return std::make_unique<SimbodyTree>(scene);
}

}  // namespace tumble::bench
