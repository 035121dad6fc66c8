#include "engine/scene/robot_files/urdf_link.hpp"

#include "engine/math/rotation.hpp"
#include "engine/scene/robot_files/attributes.hpp"
#include "engine/scene/robot_files/link_mass.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

/// A length of a shape; one that is not positive is a fault.
double read_length(Attributes& a, std::string_view name) {
  double out = 0;
  if (!a.has(name)) a.fault("", fmt::format("the attribute '{}' is missing", name));
  a.read(name, out);
  if (a.has(name) && !(out > 0)) a.fault(name, fmt::format("must be above 0, got {}", out));
  return out > 0 ? out : 1;
}

bool read_mesh(const XmlElement& e, const UrdfFiles& files, RobotGeometry& out, RobotLog& log) {
  Attributes a(e, log);
  const std::string name = a.name_of("filename");
  const auto scale = a.numbers("scale", 1, 3);
  if (scale.size() == 1) out.scale = Vec3::Constant(scale[0]);
  if (scale.size() == 2) a.fault("scale", "needs 1 or 3 numbers, got 2");
  if (scale.size() == 3) out.scale = {scale[0], scale[1], scale[2]};
  if ((out.scale.array() == 0).any()) a.fault("scale", "a factor of 0 makes the mesh flat");
  if (name.empty()) return false;
  const auto file = find_asset(name, files.file, files.packages, e.at, log);
  if (file) out.mesh = *file;
  return file.has_value();
}

/// Reads a shape or mesh; false if there is none.
bool read_geometry(const XmlElement& of, const UrdfFiles& files, RobotGeometry& out,
                   RobotLog& log) {
  const XmlElement* geometry = of.find("geometry");
  if (!geometry || geometry->children.empty()) {
    log.fault(of.at, fmt::format("<{}> has no <geometry> with a shape in it", of.name));
    return false;
  }
  const XmlElement& e = geometry->children.front();
  if (e.name == "mesh") return read_mesh(e, files, out, log);
  Attributes a(e, log);
  if (e.name == "box") {
    Vec3 size(1, 1, 1);
    if (!a.has("size")) a.fault("", "the attribute 'size' is missing");
    a.read("size", size);
    if (!(size.minCoeff() > 0)) a.fault("size", "must be above 0 along every axis");
    out.shape = robot_box(0.5 * size);
  } else if (e.name == "sphere") {
    out.shape = robot_sphere(read_length(a, "radius"));
  } else if (e.name == "cylinder" || e.name == "capsule") {
    const double radius = read_length(a, "radius"), length = read_length(a, "length");
    out.shape =
        e.name == "capsule" ? robot_capsule(radius, length) : robot_cylinder(radius, length);
    out.pose.q = out.pose.q * z_from_y();
  } else {
    log.fault(e.at,
              fmt::format("<{}> is no shape: box, cylinder, sphere, capsule or mesh", e.name));
    return false;
  }
  return true;
}

void read_inertial(const XmlElement& e, RobotLink& link, GivenInertia& given, RobotLog& log) {
  Pose origin;
  given.at = e.at;
  for (const XmlElement& child : e.children) {
    if (child.name == "origin") {
      origin = read_urdf_origin(child, log);
    } else if (child.name == "mass") {
      Attributes a(child, log);
      if (!a.has("value")) a.fault("", "the attribute 'value' is missing");
      a.read("value", link.mass.mass);
      if (link.mass.mass < 0) a.fault("value", "a mass must not be negative");
    } else if (child.name == "inertia") {
      Attributes a(child, log);
      given.at = child.at;
      Mat3 I = Mat3::Zero();
      a.read("ixx", I(0, 0));
      a.read("iyy", I(1, 1));
      a.read("izz", I(2, 2));
      a.read("ixy", I(0, 1));
      a.read("ixz", I(0, 2));
      a.read("iyz", I(1, 2));
      I(1, 0) = I(0, 1), I(2, 0) = I(0, 2), I(2, 1) = I(1, 2);
      given.tensor = I;
    } else {
      log.warn(child.at, fmt::format("<{}> of <inertial> is not followed", child.name));
    }
  }
  link.mass.centre = origin.x;
  if (!given.tensor) return;
  const Mat3 R = origin.q.toRotationMatrix();
  given.tensor = R * *given.tensor * R.transpose();
}

}  // namespace

Pose read_urdf_origin(const XmlElement& e, RobotLog& log) {
  Attributes a(e, log);
  Pose out;
  Vec3 rpy = Vec3::Zero();
  a.read("xyz", out.x);
  a.read("rpy", rpy);
  out.q = axis_angle(Vec3::UnitZ(), rpy.z()) * axis_angle(Vec3::UnitY(), rpy.y()) *
          axis_angle(Vec3::UnitX(), rpy.x());
  return out;
}

std::optional<Colour> UrdfMaterials::add(const XmlElement& e, RobotLog& log) {
  Attributes a(e, log);
  const std::string name = a.text("name").value_or("");
  std::optional<Colour> own;
  for (const XmlElement& child : e.children) {
    if (child.name == "color")
      own = Attributes(child, log).rgba("rgba");
    else
      log.warn(child.at, fmt::format("<{}> of a material is not drawn", child.name));
  }
  if (own && !name.empty()) colours_[name] = *own;
  if (own) return own;
  const auto known = colours_.find(name);
  return known == colours_.end() ? std::nullopt : std::optional(known->second);
}

RobotLink read_urdf_link(const XmlElement& e, UrdfMaterials& materials, const UrdfFiles& files,
                         RobotLog& log) {
  RobotLink out;
  out.at = e.at;
  {
    Attributes a(e, log);
    out.name = a.name_of("name");
    a.skip({"type"});
  }
  GivenInertia given;
  for (const XmlElement& child : e.children) {
    if (child.name == "inertial") {
      read_inertial(child, out, given, log);
    } else if (child.name == "visual" || child.name == "collision") {
      Attributes(child, log).skip({"name", "group"});
      RobotGeometry g;
      g.at = child.at;
      std::optional<Colour> colour;
      for (const XmlElement& part : child.children) {
        if (part.name == "origin")
          g.pose = read_urdf_origin(part, log);
        else if (part.name == "material")
          colour = materials.add(part, log);
        else if (part.name != "geometry")
          log.warn(part.at, fmt::format("<{}> of <{}> is not followed", part.name, child.name));
      }
      g.colour = colour;
      if (read_geometry(child, files, g, log))
        (child.name == "visual" ? out.drawn : out.collides).push_back(std::move(g));
    } else {
      log.warn(child.at, fmt::format("<{}> of a link is not followed", child.name));
    }
  }
  complete_mass(out, given, log);
  return out;
}

}  // namespace tumble
