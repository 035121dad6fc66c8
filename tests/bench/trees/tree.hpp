#pragma once
#include <memory>
#include <vector>

#include <Eigen/Geometry>

/// Trees of links in hinges, in every library the same. In C++ of 2017, which is what Simbody's
/// headers are written in.
namespace tumble::bench {

/// A link and the hinge before it. Its frame has its origin on the hinge.
struct TreeLink {
  int parent = -1;    ///< one that comes before, or the world
  bool free = false;  ///< no hinge ties it to the world
  Eigen::Isometry3d in_parent = Eigen::Isometry3d::Identity();  ///< at angle 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();              ///< unit, in either frame
  double angle = 0, rate = 0;                                   ///< at the start [rad], [rad/s]
  double mass = 0;                                              ///< [kg]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();             ///< of mass [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();            ///< about the centre [kg m2]

  Eigen::Isometry3d moved() const { return in_parent * Eigen::AngleAxisd(angle, axis); }
};

struct TreeScene {
  std::vector<TreeLink> links;
  Eigen::Vector3d gravity;  ///< [m/s2]
  double step = 1e-3;       ///< [s]

  /// Of a place above the origin, against gravity [m].
  double height(const Eigen::Vector3d& x) const { return -x.dot(gravity.normalized()); }
};

/// A library's tree.
class TreePeer {
 public:
  virtual ~TreePeer() = default;
  /// One evaluation of the accelerations from positions and velocities that are new: the sum over
  /// the hinges of the size of their own acceleration, by which answers are compared [rad/s2].
  virtual double evaluate() = 0;
  /// A step by a Runge-Kutta method of fourth order; returns the height of the last link's centre
  /// of mass [m].
  virtual double step() = 0;
};

std::unique_ptr<TreePeer> tumble_tree(const TreeScene& scene);
std::unique_ptr<TreePeer> mujoco_tree(const TreeScene& scene);
std::unique_ptr<TreePeer> simbody_tree(const TreeScene& scene);
std::unique_ptr<TreePeer> dart_tree(const TreeScene& scene);

}  // namespace tumble::bench
