// Columns of boxes at rest, one core: ticks of the event stepper beside steps of Bullet with its
// Dantzig solver (btMLCPSolver; single precision) and of ODE's exact dWorldStep. Peers see contacts
// only where boxes overlap and solve only what is regular, so their boxes overlap by 0.1 mm and
// their problems are regularised (CFM); without either they fail, or fall freely. Their columns
// fall within a second, so only the first steps of a fresh column are timed, where all have the
// same contacts; making it is not. The answer is how far the top box is from where it was put [m];
// what peers' solvers failed at is counted: Bullet then answers by Gauss-Seidel, ODE by what it
// has. Ours integrates by Runge and Kutta, four solutions a tick, or by the semi-implicit Euler
// method as the peers do. Then the forces of the same columns alone, from none and from nearly
// those; the answer is the residual. Argument: the most boxes (default 50).
#include "engine/dynamics/event/contact_forces.hpp"
#include "engine/world/world.hpp"
#include "tests/bench/contest.hpp"

#include <cmath>
#include <cstdarg>
#include <cstdlib>
#include <memory>

#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>
#include <ode/ode.h>

using namespace tumble;
using namespace tumble::bench;

namespace {

constexpr double edge = 0.5, friction = 0.5, mass = 125, h = 1.0 / 60;
constexpr double overlap = 1e-4;      // of peers' boxes [m]
constexpr double regularised = 1e-6;  // their CFM
constexpr int steps = 3, rounds = 9;
int ode_messages = 0;

double height(int i) {
  return edge * (i + 0.5);
}
double height_of_peer(int i) {
  return height(i) - (i + 1) * overlap;
}

class Ours {
 public:
  explicit Ours(int boxes, const char* integrator = "rk4") {
    WorldDef def;
    def.settings.stepper = "event";
    def.settings.event.integrator = integrator;
    def.threads = 1;
    world_ = std::move(*World::create(std::move(def)));
    ShapeDef ground;
    ground.type = ShapeType::half_space;
    add(ground, 0, BodyType::fixed);
    ShapeDef box;
    box.type = ShapeType::box;
    box.half_extents = Vec3::Constant(edge / 2);
    for (int i = 0; i < boxes; ++i) top_ = add(box, height(i), BodyType::dynamic);
    want_ = height(boxes - 1);
  }
  double run() {
    for (int k = 0; k < steps; ++k)
      if (!world_->step()) return 1;
    return (world_->body(top_)->pose.x - Vec3(0, want_, 0)).norm();
  }

 private:
  BodyId add(const ShapeDef& shape, double y, BodyType type) {
    BodyDef def;
    def.type = type;
    def.pose.x = {0, y, 0};
    def.shapes.push_back({shape, {}, {}});
    def.shapes[0].material.friction = friction;
    def.shapes[0].material.restitution = 0;
    const auto id = world_->create_body(std::move(def));
    (void)world_->apply_commands();
    return *id;
  }
  std::unique_ptr<World> world_;
  BodyId top_;
  double want_ = 0;
};

class OursByEuler : public Ours {
 public:
  explicit OursByEuler(int boxes) : Ours(boxes, "semi_implicit_euler") {}
};

class Bullet {
 public:
  explicit Bullet(int boxes)
      : dispatcher_(&configuration_),
        solver_(&dantzig_),
        world_(&dispatcher_, &broad_phase_, &solver_, &configuration_),
        plane_(btVector3(0, 1, 0), 0),
        box_(btVector3(btScalar(edge / 2), btScalar(edge / 2), btScalar(edge / 2))) {
    world_.setGravity(btVector3(0, btScalar(-9.81), 0));
    world_.getSolverInfo().m_minimumSolverBatchSize = 1;
    world_.getSolverInfo().m_globalCfm = btScalar(regularised);
    add(&plane_, 0, 0);
    for (int i = 0; i < boxes; ++i) add(&box_, mass, height_of_peer(i));
    want_ = height_of_peer(boxes - 1);
  }
  ~Bullet() {
    for (auto& b : bodies_) world_.removeRigidBody(b.get());
  }
  double run() {
    for (int k = 0; k < steps; ++k) world_.stepSimulation(btScalar(h), 0);
    const btVector3 x = bodies_.back()->getWorldTransform().getOrigin();
    return Vec3(double(x.x()), double(x.y()) - want_, double(x.z())).norm();
  }
  int fallbacks() const { return solver_.getNumFallbacks(); }

 private:
  void add(btCollisionShape* shape, double m, double y) {
    btVector3 inertia(0, 0, 0);
    if (m > 0) shape->calculateLocalInertia(btScalar(m), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(btScalar(m), nullptr, shape, inertia);
    info.m_startWorldTransform.setIdentity();
    info.m_startWorldTransform.setOrigin(btVector3(0, btScalar(y), 0));
    info.m_friction = btScalar(std::sqrt(friction));
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(bodies_.back().get());
  }
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broad_phase_;
  btDantzigSolver dantzig_;
  btMLCPSolver solver_;
  btDiscreteDynamicsWorld world_;
  btStaticPlaneShape plane_;
  btBoxShape box_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  double want_ = 0;
};

class Ode {
 public:
  explicit Ode(int boxes)
      : world_(dWorldCreate()), space_(dSimpleSpaceCreate(nullptr)), joints_(dJointGroupCreate(0)) {
    dWorldSetGravity(world_, 0, -9.81, 0);
    dWorldSetCFM(world_, regularised);
    dCreatePlane(space_, 0, 1, 0, 0);
    for (int i = 0; i < boxes; ++i) {
      top_ = dBodyCreate(world_);
      dMass m;
      dMassSetBoxTotal(&m, mass, edge, edge, edge);
      dBodySetMass(top_, &m);
      dBodySetPosition(top_, 0, height_of_peer(i), 0);
      dGeomSetBody(dCreateBox(space_, edge, edge, edge), top_);
    }
    want_ = height_of_peer(boxes - 1);
  }
  ~Ode() {
    dJointGroupDestroy(joints_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }
  Ode(const Ode&) = delete;
  Ode& operator=(const Ode&) = delete;
  double run() {
    for (int k = 0; k < steps; ++k) {
      dSpaceCollide(space_, this, &near);
      dWorldStep(world_, h);
      dJointGroupEmpty(joints_);
    }
    const dReal* x = dBodyGetPosition(top_);
    return Vec3(x[0], x[1] - want_, x[2]).norm();
  }

 private:
  static void near(void* self, dGeomID a, dGeomID b) {
    auto& me = *static_cast<Ode*>(self);
    dContact found[4];
    const int n = dCollide(a, b, 4, &found[0].geom, sizeof(dContact));
    for (int i = 0; i < n; ++i) {
      found[i].surface.mode = dContactApprox1;
      found[i].surface.mu = friction;
      dJointAttach(dJointCreateContact(me.world_, me.joints_, &found[i]), dGeomGetBody(a),
                   dGeomGetBody(b));
    }
  }
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID joints_;
  dBodyID top_ = nullptr;
  double want_ = 0;
};

/// The forces of a column by themselves.
struct Forces {
  std::vector<DofBlock> blocks;
  std::vector<ForcePoint> points;
  std::vector<Vec3> last;

  explicit Forces(int boxes) {
    for (int i = 0; i < boxes; ++i) {
      DofBlock& block = blocks.emplace_back();
      block.inverse_mass = 1 / mass;
      block.inverse_inertia = Vec3::Constant(6 / (mass * edge * edge)).asDiagonal();
      block.v = {0, -9.81, 0};
      for (const double x : {-edge / 2, edge / 2})
        for (const double z : {-edge / 2, edge / 2}) {
          ForcePoint& p = points.emplace_back();
          p.a = i == 0 ? no_block : uint32_t(i - 1);
          p.b = uint32_t(i);
          p.arm_a = {x, edge / 2, z};
          p.arm_b = {x, -edge / 2, z};
          p.friction = friction;
        }
    }
    (void)solve({}, last);
  }
  double solve(std::vector<Vec3> start, std::vector<Vec3>& out) const {
    std::vector<DofBlock> moving = blocks;
    const ContactForceReport r = solve_contact_forces(moving, points, {}, start);
    out = std::move(start);
    return r.solved ? r.residual : 1;
  }
  /// The forces of a column that is a little heavier to start from: nothing fits at once.
  std::vector<Vec3> nearly() const {
    std::vector<Vec3> out = last;
    for (Vec3& f : out) f *= 1.01;
    return out;
  }
};

/// Another fresh column at every call.
template <class Engine>
class Fresh {
 public:
  explicit Fresh(int boxes) {
    for (int k = 0; k <= rounds; ++k) engines_.push_back(std::make_unique<Engine>(boxes));
  }
  double run() { return engines_[next_++]->run(); }
  const std::vector<std::unique_ptr<Engine>>& all() const { return engines_; }

 private:
  std::vector<std::unique_ptr<Engine>> engines_;
  size_t next_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const int most = argc > 1 ? std::atoi(argv[1]) : 50;
  dInitODE();
  dSetMessageHandler([](int, const char*, va_list) { ++ode_messages; });
  for (const int boxes : {5, 12, 25, 50}) {
    if (boxes > most) break;
    Fresh<Ours> ours(boxes);
    Fresh<OursByEuler> by_euler(boxes);
    Fresh<Bullet> bullet(boxes);
    Fresh<Ode> ode(boxes);
    ode_messages = 0;
    const std::string title = std::to_string(boxes) + " boxes, " + std::to_string(4 * boxes) +
                              " contacts, the first " + std::to_string(steps) + " steps";
    report(title,
           {{"Bullet, Dantzig", [&] { return bullet.run(); }},
            {"ODE, dWorldStep", [&] { return ode.run(); }},
            {"tumble, rk4", [&] { return ours.run(); }},
            {"tumble, semi-implicit Euler", [&] { return by_euler.run(); }}},
           rounds);
    int fallbacks = 0;
    for (const auto& engine : bullet.all()) fallbacks += engine->fallbacks();
    std::printf("  of %d steps Bullet's Dantzig failed in %d; ODE told of %d errors\n",
                steps * (rounds + 1), fallbacks, ode_messages);
  }
  for (const int boxes : {12, 25, 50}) {
    if (boxes > most) break;
    const Forces column(boxes);
    std::vector<Vec3> out;
    report("forces of " + std::to_string(4 * boxes) + " contacts",
           {{"from none", [&] { return column.solve({}, out); }},
            {"from nearly the forces", [&] { return column.solve(column.nearly(), out); }}},
           15);
  }
  dCloseODE();
}
