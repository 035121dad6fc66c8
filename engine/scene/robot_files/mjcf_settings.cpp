#include "engine/scene/robot_files/mjcf_settings.hpp"

#include "engine/core/text.hpp"
#include "engine/math/rotation.hpp"
#include "engine/scene/robot_files/asset_paths.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr double mjcf_degree = std::numbers::pi / 180;

/// Rotations about x, y, z in the order of `sequence`; capital letters mean fixed axes.
Quat euler_of(const std::string& sequence, const std::vector<double>& angles, double unit) {
  Quat out = Quat::Identity();
  for (size_t k = 0; k < 3; ++k) {
    const char axis = sequence[k];
    const bool fixed = axis >= 'X' && axis <= 'Z';
    const Quat turn = axis_angle(Vec3::Unit(axis - (fixed ? 'X' : 'x')), unit * angles[k]);
    out = fixed ? turn * out : out * turn;
  }
  return out;
}

bool is_euler_sequence(const std::string& text) {
  return text.size() == 3 && text.find_first_not_of("xyzXYZ") == std::string::npos;
}

}  // namespace

void MjcfSettings::read_compiler(const XmlElement& e, RobotLog& log) {
  Attributes a(e, log);
  if (a.has("angle")) angle = a.word("angle", {"degree", "radian"}) == 0 ? mjcf_degree : 1;
  if (a.word("coordinate", {"local", "global"}) == 1)
    a.fault("coordinate", "'global' is not read: save the model with local coordinates");
  std::string sequence = euler;
  a.read("eulerseq", sequence);
  if (is_euler_sequence(sequence))
    euler = sequence;
  else
    a.fault("eulerseq", fmt::format("needs three of x, y, z, X, Y, Z, got '{}'", sequence));
  a.read("autolimits", autolimits);
  a.read("strippath", strip_path);
  if (a.has("inertiafromgeom"))
    inertia =
        std::array{MjcfInertia::automatic, MjcfInertia::geoms,
                   MjcfInertia::inertial}[a.word("inertiafromgeom", {"auto", "true", "false"})];
  a.read("boundmass", least_mass);
  a.read("boundinertia", least_inertia);
  if (a.has("settotalmass")) {
    double mass = -1;
    a.read("settotalmass", mass);
    if (mass > 0) total_mass = mass;
  }
  for (const char* key : {"assetdir", "meshdir"})
    if (const auto folder = a.text(key)) mesh_folder = *folder;
  a.skip({"texturedir", "discardvisual", "fusestatic", "usethread", "convexhull"});
}

void MjcfSettings::read_class(const XmlElement& e, const std::string& parent, RobotLog& log) {
  std::string name = parent.empty() ? mjcf_main_class : "";
  {
    Attributes a(e, log);
    a.read("class", name);
    if (name.empty()) a.fault("", "a nested <default> needs a 'class'");
  }
  Class& here = classes_[name];
  if (!parent.empty())
    for (const auto& [element, values] : classes_[parent])
      for (const auto& [key, value] : values) here[element].emplace(key, value);
  for (const XmlElement& child : e.children) {
    if (child.name == "default") continue;
    for (const auto& [key, text] : child.attributes) here[child.name][key] = {text, child.at};
  }
  for (const XmlElement& child : e.children)
    if (child.name == "default") read_class(child, name, log);
}

void MjcfSettings::read_assets(const XmlElement& e, RobotLog& log) {
  for (const XmlElement& asset : e.children) {
    if (asset.name == "texture") {
      Attributes a(asset, log);
      const auto name = a.text("name");
      const Colour first = a.rgba("rgb1").value_or(Colour{0.8, 0.8, 0.8});
      const Colour second = a.rgba("rgb2").value_or(Colour{0.5, 0.5, 0.5});
      const bool checker = a.text("builtin").value_or("") == "checker";
      a.skip({"type", "width", "height", "mark", "markrgb", "random", "file", "gridsize",
              "gridlayout"});
      if (name)
        textures_[*name] = !checker ? first
                                    : Colour{0.5 * (first.r + second.r), 0.5 * (first.g + second.g),
                                             0.5 * (first.b + second.b)};
      log.warn(asset.at, "<texture> is not drawn: what has it is of one colour");
    } else if (asset.name == "mesh") {
      Attributes a(asset, log);
      set_defaults(a, "mesh", mjcf_main_class, log);
      MjcfMesh mesh;
      a.read("scale", mesh.scale);
      if ((mesh.scale.array() == 0).any()) a.fault("scale", "a factor of 0 makes the mesh flat");
      const auto given = a.text("file");
      const std::filesystem::path path(given.value_or(""));
      const std::string name = a.text("name").value_or(path.stem().string());
      if (!given) {
        log.warn(asset.at, fmt::format("mesh '{}' has no file: its vertices are not read", name));
      } else {
        const auto file = find_asset((mesh_folder / (strip_path ? path.filename() : path)).string(),
                                     this->file, {}, asset.at, log);
        if (file) mesh.file = *file;
      }
      meshes[name] = mesh;
    }
  }
  for (const XmlElement& asset : e.children) {
    if (asset.name == "material") {
      Attributes a(asset, log);
      set_defaults(a, "material", mjcf_main_class, log);
      MjcfMaterial material;
      if (const auto texture = a.text("texture"))
        if (const auto known = textures_.find(*texture); known != textures_.end())
          material.colour = known->second;
      if (const auto colour = a.rgba("rgba", &material.alpha)) material.colour = *colour;
      a.skip({"texrepeat", "texuniform", "reflectance", "specular", "shininess", "emission"});
      materials[a.name_of("name")] = material;
    } else if (asset.name != "texture" && asset.name != "mesh") {
      log.warn(asset.at, fmt::format("<{}> is not read", asset.name));
    }
  }
}

void MjcfSettings::read(const XmlElement& root, RobotLog& log) {
  angle = mjcf_degree;
  for (const XmlElement& e : root.children)
    if (e.name == "compiler") read_compiler(e, log);
  for (const XmlElement& e : root.children)
    if (e.name == "default") read_class(e, "", log);
  for (const XmlElement& e : root.children)
    if (e.name == "asset") read_assets(e, log);
}

void MjcfSettings::set_defaults(Attributes& a, const std::string& element,
                                const std::string& body_class, RobotLog& log) const {
  const auto own = a.text("class");
  const std::string name = own.value_or(body_class);
  const auto found = classes_.find(name);
  if (found == classes_.end()) {
    if (!own) return;
    std::vector<std::string> names;
    for (const auto& c : classes_) names.push_back(c.first);
    log.fault(a.at(), unknown_name("class of defaults", name, names));
    return;
  }
  const auto values = found->second.find(element);
  if (values == found->second.end()) return;
  for (const auto& [key, value] : values->second) a.set_default(key, value);
}

Pose MjcfSettings::read_pose(Attributes& a) const {
  Pose out;
  a.read("pos", out.x);
  if (const auto q = a.numbers("quat", 4, 4); !q.empty()) {
    out.q = Quat(q[0], q[1], q[2], q[3]);
    if (out.q.norm() > 0)
      out.q.normalize();
    else
      a.fault("quat", "a quaternion of zeros is no orientation");
  }
  if (const auto v = a.numbers("axisangle", 4, 4); !v.empty())
    out.q = axis_angle(Vec3(v[0], v[1], v[2]), angle * v[3]);
  if (const auto v = a.numbers("euler", 3, 3); !v.empty()) out.q = euler_of(euler, v, angle);
  if (const auto v = a.numbers("zaxis", 3, 3); !v.empty()) {
    const Vec3 z(v[0], v[1], v[2]);
    if (z.norm() > 0)
      out.q = rotation_between(Vec3::UnitZ(), z.normalized());
    else
      a.fault("zaxis", "an axis of zeros has no direction");
  }
  if (const auto v = a.numbers("xyaxes", 6, 6); !v.empty()) {
    const Vec3 x(v[0], v[1], v[2]), y(v[3], v[4], v[5]);
    if (x.cross(y).norm() > 0) {
      Mat3 R;
      R.col(0) = x.normalized();
      R.col(2) = x.cross(y).normalized();
      R.col(1) = R.col(2).cross(R.col(0));
      out.q = Quat(R).normalized();
    } else {
      a.fault("xyaxes", "x and y must not be parallel");
    }
  }
  return out;
}

}  // namespace tumble
