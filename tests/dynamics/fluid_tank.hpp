#pragma once
#include "engine/core/random.hpp"
#include "engine/dynamics/sph/fluid_solver.hpp"
#include "engine/math/rotation.hpp"

#include <memory>
#include <vector>

namespace tumble {

/// A fluid, walls that stand still (body 0), and boxes that float: the solver without a world.
struct FluidTank {
  FluidDef def;
  std::vector<FluidDef> others;  ///< fluids behind the first
  Vec3 gravity{0, -9.81, 0};
  double h = 1.0 / 60;
  Crew* crew = nullptr;
  std::vector<Vec3> x, v;
  std::vector<double> pressure, mass;
  std::vector<uint8_t> fluid;  ///< 0: of `def`; k: of others[k - 1]; empty: all of `def`
  std::vector<FluidBody> bodies;
  std::vector<FluidWall> walls;
  FluidSolver solver;
  FluidReport last;

  /// A tank from 0 to `size` without a lid, of boxes side by side.
  void add_walls(const Vec3& size) {
    bodies.push_back({});
    const double t = 0.2;
    const Vec3 c = 0.5 * size;
    add_wall({c[0], -t, c[2]}, {c[0] + 2 * t, t, c[2] + 2 * t});
    for (const double side : {-t, size[0] + t})
      add_wall({side, c[1], c[2]}, {t, c[1], c[2] + 2 * t});
    for (const double side : {-t, size[2] + t}) add_wall({c[0], c[1], side}, {c[0], c[1], t});
  }
  void add_wall(const Vec3& centre, const Vec3& half_extents, uint32_t body = 0) {
    ShapeDef box;
    box.type = ShapeType::box;
    box.half_extents = half_extents;
    shapes_.push_back(make_shape(box).value());
    walls.push_back({shapes_.back().get(), {centre, Quat::Identity()}, body});
  }
  /// A box that moves, and its index among the bodies.
  uint32_t add_box(const Vec3& centre, const Vec3& e, double density) {
    FluidBody b;
    const double m = density * 8 * e.prod();
    b.centre = centre;
    b.inverse_mass = 1 / m;
    const Vec3 square = e.cwiseProduct(e);
    b.inverse_inertia = (3 / m *
                         Vec3(1 / (square[1] + square[2]), 1 / (square[0] + square[2]),
                              1 / (square[0] + square[1])))
                            .asDiagonal();
    b.acceleration = gravity;
    bodies.push_back(b);
    add_wall(centre, e, uint32_t(bodies.size() - 1));
    return uint32_t(bodies.size() - 1);
  }
  /// A body of any shape at `centre`, which has to be the shape's centre of mass; density 0: it
  /// stands still.
  uint32_t add_body(const ShapeDef& def, const Vec3& centre, double density) {
    shapes_.push_back(make_shape(def).value());
    const Shape& shape = *shapes_.back();
    FluidBody b;
    b.centre = centre;
    if (density > 0) {
      const MassProperties unit = shape.mass_properties().value();
      b.inverse_mass = 1 / (density * unit.mass);
      b.inverse_inertia = Mat3(density * unit.inertia).inverse();
      b.acceleration = gravity;
    }
    bodies.push_back(b);
    walls.push_back({&shape, {centre, Quat::Identity()}, uint32_t(bodies.size() - 1)});
    return uint32_t(bodies.size() - 1);
  }
  void fill(const Vec3& low, const Vec3& high, double s) {
    fill_if(low, high, s, [](const Vec3&) { return true; });
  }
  template <class Where>
  void fill_if(const Vec3& low, const Vec3& high, double s, const Where& where) {
    for (double z = low[2] + s / 2; z < high[2]; z += s)
      for (double y = low[1] + s / 2; y < high[1]; y += s)
        for (double a = low[0] + s / 2; a < high[0]; a += s)
          if (where(Vec3(a, y, z))) x.push_back({a, y, z});
    v.assign(x.size(), Vec3::Zero());
    pressure.assign(x.size(), 0);
    mass.assign(x.size(), def.density * s * s * s);
  }
  /// Makes these of `others[kind - 1]`, where they keep their volume.
  template <class Where>
  void change_if(uint8_t kind, const Where& where) {
    fluid.resize(x.size(), 0);
    for (size_t i = 0; i < x.size(); ++i)
      if (where(x[i])) {
        fluid[i] = kind;
        mass[i] *= others[kind - 1].density / def.density;
      }
  }
  void carve(double clearance) {
    const std::vector<uint8_t> inside = inside_walls(x, walls, clearance);
    size_t kept = 0;
    for (size_t i = 0; i < x.size(); ++i)
      if (!inside[i]) x[kept++] = x[i];
    x.resize(kept), v.resize(kept), pressure.resize(kept), mass.resize(kept);
  }
  /// One tick: the bodies move as semi-implicit Euler moves them.
  bool step() {
    const std::vector<Vec3> acceleration(x.size(), gravity);
    std::vector<const FluidDef*> defs{&def};
    for (const FluidDef& other : others) defs.push_back(&other);
    const auto done =
        solver.step(defs, {x, v, pressure, mass, acceleration, fluid}, {h, bodies, walls}, crew);
    if (!done) return false;
    last = *done;
    for (size_t k = 0; k < bodies.size(); ++k) {
      FluidBody& b = bodies[k];
      if (b.inverse_mass == 0) continue;
      const FluidPush& push = solver.pushes()[k];
      b.velocity += h * b.acceleration + b.inverse_mass * push.impulse;
      b.angular_velocity += b.inverse_inertia * push.angular_impulse;
      const Vec3 from = b.centre;
      b.centre += h * b.velocity;
      const Quat turn = integrate_rotation(Quat::Identity(), b.angular_velocity, h);
      b.inverse_inertia =
          turn.toRotationMatrix() * b.inverse_inertia * turn.toRotationMatrix().transpose();
      for (FluidWall& w : walls)
        if (w.body == k) w.pose = {b.centre + turn * (w.pose.x - from), turn * w.pose.q};
    }
    return true;
  }

  double volume() const {
    double sum = 0;
    for (const double m : mass) sum += m;
    return sum / def.density;
  }
  double weight() const { return volume() * def.density * gravity.norm(); }
  double kinetic_energy() const {
    double sum = 0;
    for (size_t i = 0; i < x.size(); ++i) sum += 0.5 * mass[i] * v[i].squaredNorm();
    return sum;
  }
  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (size_t i = 0; i < x.size(); ++i) sum += mass[i] * v[i];
    for (const FluidBody& b : bodies)
      if (b.inverse_mass > 0) sum += b.velocity / b.inverse_mass;
    return sum;
  }
  Vec3 angular_momentum() const {
    Vec3 sum = Vec3::Zero();
    for (size_t i = 0; i < x.size(); ++i) sum += mass[i] * x[i].cross(v[i]);
    for (const FluidBody& b : bodies)
      if (b.inverse_mass > 0)
        sum += b.centre.cross(b.velocity) / b.inverse_mass +
               b.inverse_inertia.inverse() * b.angular_velocity;
    return sum;
  }
  /// How deep a prism with this foot stands in the tank's fluid, whose level it raises.
  double submerged(double bottom, double foot, double area) const {
    return (volume() - foot * bottom) / (area - foot) - bottom;
  }

 private:
  std::vector<std::shared_ptr<const Shape>> shapes_;
};

}  // namespace tumble
