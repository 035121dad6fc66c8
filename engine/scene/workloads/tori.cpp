#include "engine/geometry/make_mesh.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/scene/workloads/definitions.hpp"
#include "engine/scene/workloads/draws.hpp"
#include "engine/scene/workloads/parts.hpp"

namespace tumble {
namespace {

constexpr double major = 0.5, minor = 0.2;  ///< radii [m]
constexpr double half_ground = 16;          ///< [m]
constexpr uint32_t cells = 64;

double ground_height(double x, double z) {
  return 0.5 * det::sin(0.5 * x) * det::cos(0.5 * z) + 0.004 * (x * x + z * z);
}

/// A grid of squares, each cut from its corner of greatest x to that of greatest z.
TriangleMesh ground_mesh() {
  const double size = 2 * half_ground / cells;
  TriangleMesh m;
  for (uint32_t i = 0; i <= cells; ++i) {
    for (uint32_t j = 0; j <= cells; ++j) {
      const double x = size * j - half_ground, z = size * i - half_ground;
      m.vertices.emplace_back(x, ground_height(x, z), z);
    }
  }
  for (uint32_t i = 0; i < cells; ++i) {
    for (uint32_t j = 0; j < cells; ++j) {
      const uint32_t a = i * (cells + 1) + j, along_x = a + 1, along_z = a + cells + 1;
      m.triangles.push_back({a, along_z, along_x});
      m.triangles.push_back({along_x, along_z, along_z + 1});
    }
  }
  return m;
}

BodyDef ground() {
  ShapeDef shape;
  shape.type = ShapeType::triangle_mesh;
  shape.mesh = std::make_shared<TriangleMesh>(ground_mesh());
  BodyDef def;
  def.type = BodyType::fixed;
  def.shapes.push_back({std::move(shape), {}, {}});
  return def;
}

Vec3 middle_of_tube(double turn) {
  return major * Vec3(det::cos(turn), 0, -det::sin(turn));
}

/// Piece k of twelve: the hull of two octagonal cross sections of the tube.
BodyShapeDef segment(int k) {
  const auto turn = [](double part) { return 2 * det::pi * part / 12; };
  const Vec3 centre = middle_of_tube(turn(k + 0.5));
  auto mesh = std::make_shared<TriangleMesh>();
  for (int end = 0; end < 2; ++end) {
    const Vec3 middle = middle_of_tube(turn(k + end));
    for (int j = 0; j < 8; ++j) {
      const double around = 2 * det::pi * (j + 0.5) / 8;
      const Vec3 out = minor * det::cos(around) * middle.normalized();
      mesh->vertices.push_back(middle + out + minor * det::sin(around) * Vec3::UnitY() - centre);
    }
  }
  ShapeDef shape;
  shape.type = ShapeType::convex_hull;
  shape.mesh = std::move(mesh);
  return {std::move(shape), {centre, Quat::Identity()}, {}};
}

BodyShapeDef whole_mesh() {
  ShapeDef shape;
  shape.type = ShapeType::triangle_mesh;
  shape.mesh = std::make_shared<TriangleMesh>(make_mesh::torus(major, minor, 24, 12));
  return {std::move(shape), {}, {}};
}

/// Tori with the mass properties of the smooth one, whatever their shapes, fall on wavy ground.
Workload tori_workload(bool small, const std::vector<BodyShapeDef>& shapes) {
  const int side = small ? 3 : 8, count = small ? 16 : 200;
  const MassProperties mass = torus_mass(major, minor, 1000);
  Workload w;
  w.steps = 300;
  w.tori = ToriOnTerrain{major, minor, half_ground, ground_height, nullptr, 0};
  w.bodies.push_back(ground());
  WorkloadDraws draws(99);
  for (int i = 0; i < count; ++i) {
    BodyDef body;
    body.pose = {layered_place(i, side, 1.6, 3), draws.orientation()};
    body.shapes = shapes;
    body.mass = mass.mass;
    body.inertia = mass.inertia.diagonal();
    w.bodies.push_back(std::move(body));
  }
  return w;
}

}  // namespace

/// W7m: each torus a mesh of 24 x 12 squares.
Workload mesh_tori_workload(bool small) {
  Workload w = tori_workload(small, {whole_mesh()});
  w.tori->facets = w.bodies.back().shapes[0].shape.mesh;
  w.tori->cells = int(cells);
  return w;
}

/// W7c: each torus a ring of twelve convex pieces.
Workload compound_tori_workload(bool small) {
  std::vector<BodyShapeDef> shapes;
  for (int k = 0; k < 12; ++k) shapes.push_back(segment(k));
  return tori_workload(small, shapes);
}

}  // namespace tumble
