#include "tests/bench/trees/tree.hpp"

#include <array>
#include <cmath>
#include <string>

#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/DegreeOfFreedom.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>

namespace tumble::bench {
namespace {

namespace dd = dart::dynamics;

class DartTree final : public TreePeer {
 public:
  explicit DartTree(const TreeScene& scene) : scene_(scene), tree_(dd::Skeleton::create("tree")) {
    tree_->setGravity(scene.gravity);
    std::vector<dd::BodyNode*> bodies;
    for (const TreeLink& link : scene.links) {
      dd::BodyNode* const parent = link.parent < 0 ? nullptr : bodies[size_t(link.parent)];
      bodies.push_back(link.free ? add_free(link, parent) : add_hinge(link, parent));
      bodies.back()->setInertia(dd::Inertia(link.mass, link.centre, link.inertia));
    }
    tip_ = bodies.back();
  }

  double evaluate() override {
    // Setting a value forgets all that followed from it.
    tree_->setPositions(tree_->getPositions());
    tree_->setVelocities(tree_->getVelocities());
    tree_->computeForwardDynamics();
    double sum = 0;
    for (const dd::DegreeOfFreedom* hinge : hinges_) sum += std::fabs(hinge->getAcceleration());
    return sum;
  }

  /// Its own integrator is of first order; this is the classical method around its accelerations.
  double step() override {
    const Eigen::VectorXd q = tree_->getPositions(), v = tree_->getVelocities();
    Eigen::VectorXd speed = v, moved = Eigen::VectorXd::Zero(v.size()), pushed = moved;
    constexpr std::array weights{1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}, ahead{0.5, 0.5, 1.0, 0.0};
    for (size_t k = 0; k < weights.size(); ++k) {
      tree_->computeForwardDynamics();
      const Eigen::VectorXd a = tree_->getAccelerations();
      moved += weights[k] * speed;
      pushed += weights[k] * a;
      const bool last = k + 1 == weights.size();
      move_from(q, last ? moved : speed, last ? scene_.step : ahead[k] * scene_.step);
      speed = last ? Eigen::VectorXd(v + scene_.step * pushed)
                   : Eigen::VectorXd(v + ahead[k] * scene_.step * a);
      tree_->setVelocities(speed);
    }
    return scene_.height(tip_->getCOM());
  }

 private:
  /// Of the next body: it tells of every name that it has to make up.
  std::string name() const { return std::to_string(tree_->getNumBodyNodes()); }
  void move_from(const Eigen::VectorXd& q, const Eigen::VectorXd& speed, double h) {
    tree_->setPositions(q);
    tree_->setVelocities(speed);
    tree_->integratePositions(h);
  }
  dd::BodyNode* add_free(const TreeLink& link, dd::BodyNode* parent) {
    dd::FreeJoint::Properties joint;
    joint.mName = "joint " + name();
    const auto made = tree_->createJointAndBodyNodePair<dd::FreeJoint>(
        parent, joint, dd::BodyNode::AspectProperties(name()));
    made.first->setTransformFromParentBodyNode(link.in_parent);
    return made.second;
  }
  dd::BodyNode* add_hinge(const TreeLink& link, dd::BodyNode* parent) {
    dd::RevoluteJoint::Properties hinge;
    hinge.mName = "joint " + name();
    hinge.mAxis = link.axis;
    hinge.mT_ParentBodyToJoint = link.in_parent;
    const auto made = tree_->createJointAndBodyNodePair<dd::RevoluteJoint>(
        parent, hinge, dd::BodyNode::AspectProperties(name()));
    made.first->setPosition(0, link.angle);
    made.first->setVelocity(0, link.rate);
    hinges_.push_back(made.first->getDof(0));
    return made.second;
  }

  TreeScene scene_;
  dd::SkeletonPtr tree_;
  std::vector<const dd::DegreeOfFreedom*> hinges_;
  dd::BodyNode* tip_ = nullptr;
};

}  // namespace

std::unique_ptr<TreePeer> dart_tree(const TreeScene& scene) {
  return std::make_unique<DartTree>(scene);
}

}  // namespace tumble::bench
