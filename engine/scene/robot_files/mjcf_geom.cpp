#include "engine/scene/robot_files/mjcf_geom.hpp"

#include "engine/core/text.hpp"
#include "engine/math/rotation.hpp"
#include "engine/scene/robot_files/link_mass.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

namespace geom_type {
enum : size_t { sphere, plane, hfield, capsule, ellipsoid, cylinder, box, mesh };
}  // namespace geom_type

/// How many numbers of `size` a type needs, without `fromto`.
size_t sizes_of(size_t type, bool between) {
  if (type == geom_type::sphere) return 1;
  if (type == geom_type::capsule || type == geom_type::cylinder) return between ? 1 : 2;
  if (type == geom_type::ellipsoid || type == geom_type::box) return between ? 1 : 3;
  return 0;
}

/// Places a shape by `fromto`, the ends of its z axis; returns half the length.
double place_between(const std::vector<double>& ends, Pose& pose, Attributes& a) {
  const Vec3 from(ends[0], ends[1], ends[2]), to(ends[3], ends[4], ends[5]);
  const Vec3 along = from - to;
  if (!(along.norm() > 0)) {
    a.fault("fromto", "its two ends are one point");
    return 1;
  }
  pose.x = 0.5 * (from + to);
  pose.q = rotation_between(Vec3::UnitZ(), along.normalized());
  return 0.5 * along.norm();
}

/// Makes the shape of a primitive; `half`: half its length from `fromto`.
void make_primitive(size_t type, std::vector<double> size, const std::optional<double>& half,
                    Attributes& a, RobotGeometry& out) {
  const size_t needed = sizes_of(type, half.has_value());
  if (size.size() < needed) {
    a.fault("size",
            fmt::format("needs {} number{}, got {}", needed, needed == 1 ? "" : "s", size.size()));
    size.resize(3, 1);
  }
  for (size_t k = 0; k < needed; ++k)
    if (!(size[k] > 0)) {
      a.fault("size", fmt::format("must be above 0, got {}", size[k]));
      size[k] = 1;
    }
  size.resize(3, size.empty() ? 1 : size[0]);
  if (half && (type == geom_type::capsule || type == geom_type::cylinder)) size[1] = *half;
  if (half && (type == geom_type::box || type == geom_type::ellipsoid)) {
    if (!(size[1] > 0)) size[1] = size[0];
    size[2] = *half;
  }
  const Vec3 all(size[0], size[1], size[2]);
  if (type == geom_type::sphere) out.shape = robot_sphere(size[0]);
  if (type == geom_type::box) out.shape = robot_box(all);
  if (type == geom_type::ellipsoid) out.shape = robot_ellipsoid(all);
  if (type == geom_type::capsule) out.shape = robot_capsule(size[0], 2 * size[1]);
  if (type == geom_type::cylinder) out.shape = robot_cylinder(size[0], 2 * size[1]);
  if (type == geom_type::plane) out.shape = robot_plane();
  if (type == geom_type::capsule || type == geom_type::cylinder || type == geom_type::plane)
    out.pose.q = out.pose.q * z_from_y();
}

bool make_mesh(const std::string& name, const MjcfSettings& settings, Attributes& a,
               RobotGeometry& out, RobotLog& log) {
  const auto found = settings.meshes.find(name);
  if (found == settings.meshes.end()) {
    std::vector<std::string> names;
    for (const auto& m : settings.meshes) names.push_back(m.first);
    a.fault("", unknown_name("mesh", name, names));
    return false;
  }
  if (found->second.file.empty()) {
    log.warn(out.at, fmt::format("<geom>: the mesh '{}' is missing, and this with it", name));
    return false;
  }
  out.mesh = found->second.file;
  out.scale = found->second.scale;
  return true;
}

void read_look(Attributes& a, const MjcfSettings& settings, MjcfGeom& out, RobotLog& log) {
  double alpha = 1;
  if (const auto name = a.text("material")) {
    const auto known = settings.materials.find(*name);
    if (known == settings.materials.end()) {
      log.warn(a.at(), fmt::format("<geom>: there is no material '{}'", *name));
    } else {
      out.geometry.colour = known->second.colour;
      alpha = known->second.alpha;
    }
  }
  if (const auto colour = a.rgba("rgba", &alpha)) out.geometry.colour = colour;
  if (!out.geometry.colour) out.geometry.colour = Colour{0.5, 0.5, 0.5};
  double group = 0;
  a.read("group", group);
  out.drawn = alpha > 0 && group < 3;  // groups that MuJoCo's viewer shows by default
  if (alpha > 0 && alpha < 1)
    log.warn(a.at(), "<geom>: is drawn opaque, though its rgba says that one sees through it");
}

void read_surface(Attributes& a, MjcfGeom& out) {
  double type = 1, affinity = 1, dimensions = 3;
  a.read("contype", type);
  a.read("conaffinity", affinity);
  a.read("condim", dimensions);
  out.collides = type != 0 || affinity != 0;
  if (out.collides && (type != 1 || affinity != 1))
    a.warn_of({"contype", "conaffinity"}, "it collides with all but its neighbours");
  if (dimensions != 3)
    a.warn_of({"condim"}, "contacts have sliding friction, and the least of rolling and spinning");
  const auto friction = a.numbers("friction", 1, 3);
  if (friction.empty()) return;
  if (friction[0] >= 0)
    out.geometry.friction = friction[0];
  else
    a.fault("friction", "must not be negative");
  if (friction.size() > 1 && dimensions > 3)
    a.warn_of({"friction"}, "of spinning and rolling (its second and third number)");
}

}  // namespace

std::optional<MjcfGeom> read_mjcf_geom(const XmlElement& e, const std::string& body_class,
                                       const MjcfSettings& settings, RobotLog& log) {
  Attributes a(e, log);
  settings.set_defaults(a, "geom", body_class, log);
  MjcfGeom out;
  out.geometry.at = e.at;
  size_t type = a.word(
      "type", {"sphere", "plane", "hfield", "capsule", "ellipsoid", "cylinder", "box", "mesh"});
  out.geometry.pose = settings.read_pose(a);
  const auto size = a.numbers("size", 1, 3);
  const auto ends = a.numbers("fromto", 6, 6);
  std::optional<double> half;
  if (!ends.empty()) half = place_between(ends, out.geometry.pose, a);
  read_look(a, settings, out, log);
  read_surface(a, out);
  const auto mesh_name = a.text("mesh");
  if (mesh_name && type != geom_type::mesh) {
    log.warn(e.at, "<geom>: is not fitted to its mesh, but is the mesh itself");
    type = geom_type::mesh;
  }
  double density = 1000;
  std::optional<double> mass;
  a.read("density", density);
  a.read("mass", mass);
  a.skip({"name", "user"});
  if (density < 0 || mass.value_or(0) < 0) a.fault("", "mass and density must not be negative");
  if (type == geom_type::hfield) {
    log.warn(e.at, "<geom>: a height field is not made: nothing is there");
    return std::nullopt;
  }
  if (type == geom_type::mesh) {
    if (!mesh_name) a.fault("", "of type mesh needs the attribute 'mesh'");
    if (!mesh_name || !make_mesh(*mesh_name, settings, a, out.geometry, log)) return std::nullopt;
  } else {
    make_primitive(type, size, half, a, out.geometry);
  }
  const bool weighs = type != geom_type::plane && mass.value_or(density) > 0;
  if (weighs) out.mass = mass_of(out.geometry, density > 0 ? density : 1);
  if (weighs && out.mass && mass) out.mass = out.mass->times(*mass / out.mass->mass);
  return out;
}

}  // namespace tumble
