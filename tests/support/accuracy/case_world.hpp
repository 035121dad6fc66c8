#pragma once
#include "engine/math/types.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

/// Accuracy cases whose answers are known, told so that any engine can be put to them.
namespace tumble::test {

/// A box or a ball. SI units, Y up; body axes are principal axes about the centre of mass.
struct CaseBody {
  bool fixed = false;
  double radius = 0;            ///< of a ball [m]; 0: a box
  Vec3 half = Vec3::Zero();     ///< of a box [m]
  double mass = 1;              ///< [kg]
  Vec3 inertia = Vec3::Ones();  ///< [kg m2]
  Pose pose;
  Vec3 v = Vec3::Zero(), omega = Vec3::Zero();  ///< [m/s], [rad/s], world axes
  double friction = 0;           ///< two bodies have the root of the product of theirs [-]
  double friction_largest = -1;  ///< for engines that take the larger of two; negative: `friction`
  double restitution = 0;        ///< two bodies have the larger
};

/// A ball joint at a point of the world; `a` < 0 is the world.
struct CaseJoint {
  int a = -1, b = 0;
  Vec3 x_world = Vec3::Zero();
};

struct CaseScene {
  Vec3 gravity{0, -9.81, 0};
  std::vector<CaseBody> bodies;
  std::vector<CaseJoint> joints;  ///< a tree
  bool collide = true;
  bool elastic = false;  ///< restitution matters: for engines with a least speed of it
};

struct CaseState {
  Pose pose;
  Vec3 v = Vec3::Zero(), omega = Vec3::Zero();  ///< world axes
};

/// A scene in some engine.
class CaseWorld {
 public:
  virtual ~CaseWorld() = default;
  virtual void step() = 0;
  virtual CaseState state(size_t body) = 0;
  /// Acts on the centre of mass during every step from now on [N].
  virtual void set_force(size_t body, const Vec3& force) = 0;
  virtual void set_gravity(const Vec3& gravity) = 0;
};

/// Makes a scene in an engine that steps by 1/hz seconds.
using CaseMaker = std::function<std::unique_ptr<CaseWorld>(const CaseScene&, int hz)>;

CaseBody case_box(const Vec3& x, const Vec3& half, double mass, double friction);
CaseBody case_ball(const Vec3& x, double radius, double mass, double friction, double restitution);
/// A box of 100 m whose top is at y = 0.
CaseBody case_floor(double friction, double restitution = 0);

/// A scene in an engine, and what can be measured of any.
class CaseRun {
 public:
  CaseRun(const CaseScene& scene, const CaseMaker& maker, int hz);
  void step();
  CaseWorld& world() { return *world_; }
  const CaseState& operator[](size_t body) const { return states_[body]; }
  double energy() const;  ///< kinetic, and potential of gravity [J]
  double kinetic() const;
  Vec3 momentum() const;                     ///< of what is not fixed
  Vec3 angular_momentum(size_t body) const;  ///< about its centre

 private:
  void read();
  CaseScene scene_;
  std::unique_ptr<CaseWorld> world_;
  std::vector<CaseState> states_;
};

}  // namespace tumble::test
