#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/forces/spring_mesh.hpp"

#include <cstdint>
#include <vector>

namespace tumble {

/// Particles and the springs between them, before they are in a world. Anchors of nodes that are
/// its own particles say only which: tie() makes them anchors.
struct Weave {
  std::vector<ParticleDef> particles;
  SpringMesh mesh;
  std::vector<uint32_t> own;  ///< nodes that are its particles, in their order
};

/// The force of a weave whose particles are in `system`, where the first has the id `first`; others
/// follow it in their order.
SpringMeshDef tie(Weave weave, ParticleSystemId system, uint64_t first);

/// A node of a sheet that is no particle: it is held by the world or a body.
struct WeavePin {
  int row = 0, column = 0;
  Anchor anchor;
};

/// A rectangle of nodes, at rest flat and of the size that it starts with.
struct Sheet {
  Vec3 corner = Vec3::Zero();  ///< of row 0 and column 0 [m]
  Vec3 across{1, 0, 0};        ///< from the first column to the last [m]
  Vec3 down{0, 0, 1};          ///< from the first row to the last, at right angles to it [m]
  int columns = 20, rows = 20;
  double damping_ratio = 0.1;    ///< of each spring between two masses of a node [-]
  double radius = 0;             ///< of its particles; 0: two fifths of the spacing [m]
  Vec3 velocity = Vec3::Zero();  ///< [m/s]
  Vec3f colour{0.8f, 0.8f, 0.8f}, second_colour{0.8f, 0.8f, 0.8f};
  int stripe = 0;  ///< cells of one colour before those of the other; 0: one colour
  std::vector<WeavePin> pins;

  int node(int row, int column) const { return row * columns + column; }
  double cell_across() const { return across.norm() / (columns - 1); }
  double cell_down() const { return down.norm() / (rows - 1); }
};

/// A woven cloth as a thin elastic plate: a sheet pulled along its threads lengthens by its weight
/// as rho g L^2 / (2 stretch) does, at any number of nodes.
struct ClothDef {
  Sheet sheet;
  double density = 0.2;  ///< [kg/m2]
  double stretch = 300;  ///< Young's modulus times thickness, of a strip along the threads [N/m]
  double shear = 60;     ///< shear modulus times thickness [N/m]
  double bend = 0;       ///< flexural rigidity [N m]
};

/// Threads that are knotted where they cross.
struct NetDef {
  Sheet sheet;
  double density = 0.02;         ///< of a thread [kg/m]
  double stiffness = 500;        ///< of a thread: tension per strain [N]
  double thread_radius = 0.004;  ///< drawn [m]
};

/// A rope through some places, straight or hanging between each two.
struct RopeDef {
  struct Place {
    bool loose = false;     ///< a particle of the rope is there; only of the first and the last
    Anchor anchor;          ///< what holds the rope there
    Vec3 x = Vec3::Zero();  ///< where that is [m]
  };
  std::vector<Place> places;
  int segments = 20;             ///< between each two places
  double slack = 1;              ///< length between two places over their distance [-]
  double density = 0.1;          ///< [kg/m]
  double stiffness = 1e4;        ///< tension per strain [N]
  double bend = 0;               ///< flexural rigidity [N m2]
  double damping_ratio = 0.1;    ///< of each spring between two masses of a node [-]
  double radius = 0.01;          ///< [m]
  Vec3 velocity = Vec3::Zero();  ///< [m/s]
  Vec3f colour{0.8f, 0.8f, 0.8f};
  Vec3 down{0, -1, 0};  ///< where slack hangs to
};

/// Errors: what is out of range, in words.
Result<Weave> weave_cloth(const ClothDef& def);
Result<Weave> weave_net(const NetDef& def);
Result<Weave> weave_rope(const RopeDef& def);

/// Points of a chain that hangs from `a` to `b`, so many times longer than their distance: at even
/// distances along it, `segments` + 1 of them. Straight where it is no longer.
std::vector<Vec3> hanging_points(const Vec3& a, const Vec3& b, const Vec3& down, double slack,
                                 int segments);

}  // namespace tumble
