#include "engine/dynamics/particles/emission_shape.hpp"

#include "engine/dynamics/particles/random_values.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {

using tolerances::least_filling;

namespace {

Error shape_error(std::string message, std::string cure = {}) {
  return {ErrorCode::invalid_argument, std::move(message), "shape", std::move(cure)};
}

struct SizeFault {
  std::string operator()(const PointEmission&) const { return {}; }
  std::string operator()(const LineEmission& d) const { return positive("length", d.length); }
  std::string operator()(const DiscEmission& d) const {
    if (!(d.inner_radius >= 0 && d.inner_radius < d.radius))
      return fmt::format("inner_radius must be in 0..radius, got {} m", d.inner_radius);
    return positive("radius", d.radius);
  }
  std::string operator()(const SphereEmission& d) const { return positive("radius", d.radius); }
  std::string operator()(const BoxEmission& d) const { return positive("size", d.size.minCoeff()); }
  std::string operator()(const MeshSurfaceEmission& d) const { return there(d.mesh); }
  std::string operator()(const MeshVolumeEmission& d) const { return there(d.mesh); }

  static std::string positive(const char* what, double value) {
    if (value > 0 && std::isfinite(value)) return {};
    return fmt::format("{} must be > 0, got {} m", what, value);
  }
  static std::string there(const std::shared_ptr<const TriangleMesh>& mesh) {
    if (!mesh) return "there is no mesh";
    const Status valid = validate(*mesh);
    return valid ? std::string() : valid.error().message;
  }
};

}  // namespace

std::shared_ptr<const TriangleMesh>* mesh_of(EmissionShapeDef& def) {
  if (auto* surface = std::get_if<MeshSurfaceEmission>(&def)) return &surface->mesh;
  if (auto* volume = std::get_if<MeshVolumeEmission>(&def)) return &volume->mesh;
  return nullptr;
}

std::shared_ptr<const TriangleMesh> mesh_of(const EmissionShapeDef& def) {
  if (const auto* surface = std::get_if<MeshSurfaceEmission>(&def)) return surface->mesh;
  if (const auto* volume = std::get_if<MeshVolumeEmission>(&def)) return volume->mesh;
  return nullptr;
}

Result<EmissionShape> EmissionShape::make(const EmissionShapeDef& def) {
  if (std::string fault = std::visit(SizeFault{}, def); !fault.empty())
    return shape_error(std::move(fault));
  EmissionShape out;
  out.def_ = def;
  if (const auto* surface = std::get_if<MeshSurfaceEmission>(&def)) {
    double sum = 0;
    for (size_t t = 0; t < surface->mesh->triangles.size(); ++t)
      out.areas_.push_back(sum += face_area_vector(*surface->mesh, t).norm());
    if (!(sum > 0 && std::isfinite(sum)))
      return shape_error("the mesh has no surface: its triangles have no area");
  }
  if (const auto* volume = std::get_if<MeshVolumeEmission>(&def)) {
    const auto mass = mesh_mass(*volume->mesh);
    if (!mass)
      return shape_error("the mesh encloses no volume: " + mass.error().message,
                         "close it, or emit from its surface (mesh_surface)");
    const double box = bounds(*volume->mesh).extent().prod();
    if (!(mass->mass > least_filling * box))
      return shape_error(
          fmt::format("the mesh fills only {:.2g} of its box; points inside are found from {} on",
                      mass->mass / box, least_filling),
          "turn it so that its box is smaller, or emit from its surface (mesh_surface)");
    out.inside_ = all_hierarchies().front().build(volume->mesh);
  }
  return out;
}

EmissionPoint EmissionShape::draw(Random& random) const {
  return std::visit([&](const auto& shape) { return draw(shape, random); }, def_);
}

EmissionPoint EmissionShape::draw(const LineEmission& line, Random& random) const {
  return {Vec3(line.length * (random.uniform() - 0.5), 0, 0), Vec3::UnitY()};
}

EmissionPoint EmissionShape::draw(const DiscEmission& disc, Random& random) const {
  const double inner2 = disc.inner_radius * disc.inner_radius;
  const double r = std::sqrt(inner2 + random.uniform() * (disc.radius * disc.radius - inner2));
  const double angle = 2 * det::pi * random.uniform();
  return {Vec3(r * det::cos(angle), 0, r * det::sin(angle)), Vec3::UnitY()};
}

EmissionPoint EmissionShape::draw(const SphereEmission& ball, Random& random) const {
  const Vec3 n = random_unit_vector(random);
  const double r = ball.surface ? 1 : det::pow(random.uniform(), 1.0 / 3);
  return {ball.radius * r * n, n};
}

EmissionPoint EmissionShape::draw(const BoxEmission& box, Random& random) const {
  Vec3 u;
  for (int k = 0; k < 3; ++k) u[k] = random.uniform() - 0.5;
  EmissionPoint out{box.size.cwiseProduct(u), Vec3::UnitY()};
  if (!box.surface) return out;
  const Vec3 faces(box.size.y() * box.size.z(), box.size.z() * box.size.x(),
                   box.size.x() * box.size.y());
  double at = random.uniform() * faces.sum();
  int k = 0;
  while (k < 2 && at >= faces[k]) at -= faces[k++];
  const double side = random.below(2) == 0 ? -1 : 1;
  out.x[k] = 0.5 * side * box.size[k];
  out.outward = side * Vec3::Unit(k);
  return out;
}

EmissionPoint EmissionShape::draw(const MeshSurfaceEmission& surface, Random& random) const {
  const double at = random.uniform() * areas_.back();
  const auto found = std::upper_bound(areas_.begin(), areas_.end(), at);
  const auto t = size_t(std::min(found, areas_.end() - 1) - areas_.begin());
  const TriangleMesh& mesh = *surface.mesh;
  const double u = std::sqrt(random.uniform()), v = random.uniform();  // Turk 1990
  return {(1 - u) * mesh.corner(t, 0) + u * (1 - v) * mesh.corner(t, 1) + u * v * mesh.corner(t, 2),
          face_normal(mesh, t)};
}

EmissionPoint EmissionShape::draw(const MeshVolumeEmission&, Random& random) const {
  const Aabb box = inside_->bounds();
  for (;;) {
    Vec3 x;
    for (int k = 0; k < 3; ++k) x[k] = random.uniform(box.min[k], box.max[k]);
    if (point_in_object(x, *inside_).side == PointSide::inside) return {x, Vec3::UnitY()};
  }
}

}  // namespace tumble
