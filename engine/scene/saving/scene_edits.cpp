#include "engine/scene/saving/scene_edits.hpp"

#include "engine/geometry/triangle_mesh.hpp"
#include "engine/scene/build/describe_body.hpp"
#include "engine/scene/build/describe_joint.hpp"
#include "engine/scene/build/mesh_parts.hpp"
#include "engine/scene/reader.hpp"
#include "engine/scene/saving/json_text_edit.hpp"
#include "engine/scene/visitors/object_writer.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

namespace tumble {
namespace {

using Path = JsonTextEdit::Path;

Path operator/(Path path, std::string_view key) {
  path.push_back({std::string(key), {}});
  return path;
}
Path at_index(Path path, size_t index) {
  path.push_back({{}, index});
  return path;
}

/// On one line, with a space inside brackets, as scenes are written.
std::string one_line(const Json& value) {
  if (value.is_array()) {
    std::string out = "[";
    for (size_t i = 0; i < value.size(); ++i) out += (i ? ", " : "") + one_line(value[i]);
    return out + "]";
  }
  if (!value.is_object()) return value.dump();
  if (value.empty()) return "{}";
  std::string out = "{ ";
  for (const auto& item : value.items())
    out += (out.size() > 2 ? ", " : "") + Json(item.key()).dump() + ": " + one_line(item.value());
  return out + " }";
}

/// "brick[3]" -> brick, 3.
struct BodyName {
  std::string base;
  std::optional<std::string> copy;
};
BodyName split_name(const std::string& name) {
  const size_t open = name.rfind('[');
  if (open == std::string::npos || !name.ends_with(']')) return {name, {}};
  return {name.substr(0, open), name.substr(open + 1, name.size() - open - 2)};
}

Json number_of(const ShapeDef& shape, const ShapeParameter& p) {
  if (p.number) return to_json(shape.*p.number / p.factor);
  return to_json(Vec3(shape.*p.vector / p.factor));
}

/// The material by its name where it is a built-in one, else what differs from the default.
Json material_json(const Material& material) {
  const Json all = ObjectWriter::write_all(describe_material(material));
  for (const auto& [name, m] : built_in_materials())
    if (ObjectWriter::write_all(describe_material(m)) == all) return std::string(name);
  const Json usual = ObjectWriter::write_all(describe_material(Material{}));
  Json out = Json::object();
  for (const auto& item : all.items())
    if (usual[item.key()] != item.value()) out[item.key()] = item.value();
  return out;
}

Json body_json(const BodyDef& def) {
  BodyDescription d = describe_body(def);
  d.placement.turn(def.pose.q);
  Json out = ObjectWriter::write_object(d);
  Json shapes = Json::array();
  for (const BodyShapeDef& part : def.shapes) {
    Json shape = {{"type", std::string(shape_entry(part.shape.type).name)}};
    for (const ShapeParameter& p : shape_entry(part.shape.type).parameters)
      shape[std::string(p.parameter.name)] = number_of(part.shape, p);
    Placement place;
    place.position = part.pose.x;
    place.turn(part.pose.q);
    if (!place.position.isZero(0)) shape["position"] = to_json(place.position);
    if (place.euler_deg) shape["euler_deg"] = to_json(*place.euler_deg);
    if (place.orientation) shape["orientation"] = to_json(*place.orientation);
    shapes.push_back(std::move(shape));
  }
  if (shapes.size() == 1)
    out["shape"] = shapes[0];
  else
    out["shapes"] = std::move(shapes);
  if (!def.shapes.empty()) out["material"] = material_json(def.shapes[0].material);
  return out;
}

/// What is by default is left out.
Json drive_json(const CoordinateDrive& drive, bool angle) {
  return ObjectWriter::write_object(describe_drive(drive, angle));
}

bool list_of_objects(const Json& value) {
  return value.is_array() && !value.empty() &&
         std::ranges::all_of(value, [](const Json& item) { return item.is_object(); });
}

Json part_json(const PartDescription& part) {
  return std::visit([](const auto& d) { return ObjectWriter::write_object(d); }, part);
}

/// From a folder as the file system goes: ".." leaves where a link to a folder leads.
std::filesystem::path relative_name(const std::filesystem::path& file,
                                    const std::filesystem::path& folder) {
  std::error_code none;
  const auto there = std::filesystem::weakly_canonical(file.parent_path(), none);
  const auto here = std::filesystem::weakly_canonical(folder, none);
  if (there.empty() || here.empty()) return file.lexically_relative(folder);
  return (there / file.filename()).lexically_relative(here);
}

/// Carries out one change after the other.
struct Save {
  JsonTextEdit edit;
  std::vector<std::string> left_out;
  std::vector<TakenAlong> along;
  std::filesystem::path folder{};  ///< of the file; empty: not known

  void set(const Path& path, const Json& value) {
    if (edit.set(path, one_line(value))) return;
    left_out.push_back(fmt::format("{}: there is no place for it in the file", path.back().key));
  }

  /// Sets the members in which two objects differ; what is as by default now is removed.
  void merge(const Path& path, const Json& before, const Json& after) {
    for (const auto& item : after.items()) {
      const auto old = before.find(item.key());
      if (old != before.end() && *old == item.value()) continue;
      const Path own = path / item.key();
      const Json was = old == before.end() ? Json() : *old;
      const auto text = edit.value(own);
      if (item.value().is_object() && (!text || text->starts_with('{')))
        merge(own, was.is_object() ? was : Json::object(), item.value());
      else if (text && list_of_objects(was) && list_of_objects(item.value()) &&
               was.size() == item.value().size() && (was.size() == 1 || text->starts_with('[')))
        for (size_t i = 0; i < was.size(); ++i)  // one alone may stand without brackets
          merge(text->starts_with('[') ? at_index(own, i) : own, was[i], item.value()[i]);
      else
        set(own, item.value());
    }
    for (const auto& item : before.items())
      if (!after.contains(item.key())) edit.remove(path / item.key());
  }

  void operator()(const ChangedSettings& c) {
    merge(Path{} / "settings", ObjectWriter::write_all(c.before), ObjectWriter::write_all(c.after));
  }
  void operator()(const ChangedParameter& c) {
    const Path path = Path{} / "parameters" / c.name;
    const auto now = edit.value(path);
    set(now && now->starts_with('{') ? path / "value" : path, c.value);
  }
  /// The name in the file of a mesh, which is put there unless it is there already.
  std::string name_mesh(const MeshOfBody& mesh) {
    std::filesystem::path file = mesh.file;
    if (!folder.empty())
      if (const auto from_here = relative_name(mesh.file, folder); !from_here.empty())
        file = from_here;
    Json entry = {{"file", file.generic_string()}, {"centre", true}};
    if (mesh.scale != 1) entry["scale"] = mesh.scale;
    const std::string stem = name_after(mesh.file), text = one_line(entry);
    for (int n = 1;; ++n) {
      const std::string name = n == 1 ? stem : fmt::format("{}_{}", stem, n);
      const Path place = Path{} / "meshes" / name;
      const auto there = edit.value(place);
      if (!there) set(place, entry);
      if (!there || *there == text) return name;
    }
  }

  void add_mesh_body(const AddedBody& c) {
    BodyDef shapeless = c.def;
    shapeless.shapes.clear();
    Json body = body_json(shapeless);
    body.erase("shapes");
    body["shape"] = {{"type", "mesh"}, {"mesh", name_mesh(*c.mesh)}};
    if (c.mesh->mode != MeshMode::triangle_mesh)
      body["shape"]["mode"] = std::string(enum_name(c.mesh->mode));
    body["material"] = material_json(c.mesh->material);
    set(Path{} / "bodies" / c.def.name, body);
  }

  /// Where the file describes the body that a name stands for, an emitted one included.
  std::optional<Path> described(const std::string& name) const {
    const std::string base = split_name(name).base;
    const Path body = Path{} / "bodies" / base;
    if (edit.value(body)) return body;
    const auto emitted = edit.value(Path{} / "emitters" / base / "body");
    if (!emitted || !emitted->starts_with('"') || emitted->size() < 2) return std::nullopt;
    const Path source = Path{} / "bodies" / emitted->substr(1, emitted->size() - 2);
    return edit.value(source) ? std::optional(source) : std::nullopt;
  }

  /// A copy of a body of meshes: its shapes are those of the original, word for word.
  void add_copy(const AddedBody& c, const Path& original) {
    BodyDef shapeless = c.def;
    shapeless.shapes.clear();
    shapeless.drawn.clear();
    Json body = body_json(shapeless);
    body.erase("shapes");
    const Path own = Path{} / "bodies" / c.def.name;
    set(own, body);
    const BodyName name = split_name(c.like);
    for (const char* key : {"shape", "shapes", "material", "density"}) {
      auto text = edit.value(original / key);
      // One of several may have a material of its own.
      if (name.copy)
        if (const auto single = edit.value(original / "copies" / *name.copy / key)) text = single;
      if (text && !edit.set(own / key, std::string(*text)))
        left_out.push_back(fmt::format("{}: there is no place for its {}", c.def.name, key));
    }
    // One that collides in another way by now than the file says.
    const std::vector<ShapeGroup> groups = shape_groups(c.def);
    for (size_t g = 0; g < groups.size(); ++g)
      if (const auto source = source_of(c.def, groups[g]))
        set_mode(shape_path({c.def.name, {}}, g), source->how.mode);
  }

  /// As what the file says that the mesh of a shape collides, with quotes; "" where it does not
  /// say.
  std::string said_mode(const Path& shape) const {
    const auto type = edit.value(shape / "type"), mesh = edit.value(shape / "mesh");
    if (type == "\"convex_hull\"") return mesh ? "\"convex_hull\"" : "";
    if (type == "\"triangle_mesh\"") return std::string(*type);
    if (type != "\"mesh\"") return {};
    if (const auto own = edit.value(shape / "mode")) return std::string(*own);
    if (!mesh || mesh->size() < 2) return {};
    const Path entry = Path{} / "meshes" / mesh->substr(1, mesh->size() - 2);
    return std::string(edit.value(entry / "mode").value_or("\"triangle_mesh\""));
  }

  /// As what it collides from now on; false where the file does not say that of a mesh.
  bool set_mode(const Path& shape, MeshMode mode) {
    const std::string now = said_mode(shape);
    if (now.empty()) return false;
    if (now == fmt::format("\"{}\"", enum_name(mode))) return true;
    set(shape / "type", "mesh");
    set(shape / "mode", std::string(enum_name(mode)));
    for (const char* of_old : {"concavity", "pieces", "cell", "error"}) edit.remove(shape / of_old);
    return true;
  }

  void operator()(const AddedBody& c) {
    if (c.mesh) return add_mesh_body(c);
    const auto of_mesh = [](const auto& part) { return made_of_mesh(part.shape.type); };
    const auto sourced = [](const auto& part) { return part.source != nullptr; };
    const bool meshes = std::ranges::any_of(c.def.shapes, of_mesh) ||
                        std::ranges::any_of(c.def.shapes, sourced) || !c.def.drawn.empty();
    const auto original = meshes && !c.like.empty() ? described(c.like) : std::nullopt;
    if (original)
      add_copy(c, *original);
    else if (meshes)
      left_out.push_back(fmt::format(
          "{}: the file of its mesh is not known, {}", c.def.name,
          c.like.empty() ? "as it was pasted from another scene: add it from its file"
                         : fmt::format("as {} is not among the bodies of this file", c.like)));
    else
      set(Path{} / "bodies" / c.def.name, body_json(c.def));
  }

  /// Whatever names what is gone goes along.
  void drop(std::string_view list, const std::string& name) {
    std::ranges::move(drop_dependents(edit, list, name), std::back_inserter(along));
  }

  /// False, and said unless an emitter made it, where the file has no such body: one of a robot,
  /// or one that could not be added.
  bool has_body(const std::string& name) {
    const BodyName parts = split_name(name);
    const Path body = Path{} / "bodies" / parts.base;
    if (edit.value(parts.copy ? body / "repeat" : body)) return true;
    if (!parts.copy || !edit.value(Path{} / "emitters" / parts.base))
      left_out.push_back(fmt::format("{}: it is not among the bodies of the file", name));
    return false;
  }

  void operator()(const RemovedBody& c) {
    if (!has_body(c.name)) return;
    const BodyName name = split_name(c.name);
    if (name.copy) {
      if (const std::string holder = held_by_count(edit, c.name); !holder.empty()) {
        left_out.push_back(fmt::format(
            "{}: it stays, because {} is made several times by one description", c.name, holder));
        return;
      }
      set(Path{} / "bodies" / name.base / "copies" / *name.copy / "present", false);
    } else {
      edit.remove(Path{} / "bodies" / name.base);
    }
    drop("bodies", c.name);
  }

  void operator()(const AddedJoint& c) {
    const JointKindEntry& kind = entry_of(c.def.kind);
    Json out = {{"kind", std::string(kind.name)}};
    if (!c.a.empty()) out["a"] = c.a;
    out["b"] = c.b;
    out["anchor"] = to_json(c.def.frame_a.x);
    if (kind.uses_axes) out["axis"] = to_json(Vec3(c.def.frame_a.direction(Vec3::UnitZ())));
    if (c.def.kind == JointKind::distance || c.def.kind == JointKind::free)
      out["anchor_b"] = to_json(c.def.frame_b.x);
    if (c.def.kind == JointKind::distance) out["length"] = c.def.length;
    if (c.def.collide) out["collide"] = true;
    for (size_t k = 0; k < kind.coordinates.size(); ++k) {
      const CoordinateDrive& drive = c.def.drives[k];
      if (drive.couple || drive.motor.course)
        left_out.push_back(fmt::format(
            "{}: what couples it, and targets that change over time, are not copied", c.def.name));
      const Json described = drive_json(drive, kind.coordinates[k].angle);
      if (kind.coordinates.size() == 1)
        out.update(described);
      else if (!described.empty())
        out[std::string(kind.coordinates[k].name)] = described;
    }
    if (c.def.break_force < no_bound) out["break_force"] = c.def.break_force;
    if (c.def.break_torque < no_bound) out["break_torque"] = c.def.break_torque;
    set(Path{} / "joints" / c.def.name, out);
  }

  void operator()(const ChangedJoint& c) {
    const JointKindEntry& kind = entry_of(c.after.kind);
    const BodyName name = split_name(c.after.name);
    const Path path = Path{} / "joints" / name.base;
    if (name.copy || !edit.value(path)) {
      left_out.push_back(fmt::format("{}: {}", c.after.name,
                                     name.copy ? "what a joint does is common to all copies, so "
                                                 "that one cannot have its own"
                                               : "it is not among the joints of the file"));
      return;
    }
    for (size_t k = 0; k < kind.coordinates.size(); ++k) {
      const bool angle = kind.coordinates[k].angle;
      const Json before = drive_json(c.before.drives[k], angle);
      const Json after = drive_json(c.after.drives[k], angle);
      if (before == after) continue;
      const Path own = path / kind.coordinates[k].name;
      merge_drive(kind.coordinates.size() == 1 && !edit.value(own) ? path : own, before, after,
                  angle);
    }
    for (const auto& [key, member] : {std::pair("break_force", &JointDef::break_force),
                                      std::pair("break_torque", &JointDef::break_torque)}) {
      if (c.before.*member == c.after.*member) continue;
      if (c.after.*member < no_bound)
        set(path / key, c.after.*member);
      else
        edit.remove(path / key);
    }
  }

  /// A value that changes is in the one unit that is written here.
  void merge_drive(const Path& path, const Json& before, const Json& after, bool angle) {
    const char* suffix = angle ? "" : "_deg";
    for (const char* key : {"lower", "upper"})
      if (before.value("limits", Json::object()) != after.value("limits", Json::object()))
        edit.remove(path / "limits" / (std::string(key) + suffix));
    for (const auto& [part, key] : {std::pair("spring", "rest"), std::pair("motor", "position")})
      if (before.value(part, Json::object()) != after.value(part, Json::object()))
        edit.remove(path / part / (std::string(key) + suffix));
    merge(path, before, after);
    for (const char* part : {"limits", "motor", "spring"})
      if (before.contains(part) && !after.contains(part)) edit.remove(path / part);
  }

  void operator()(const RemovedJoint& c) {
    const BodyName name = split_name(c.name);
    if (name.copy || !edit.remove(Path{} / "joints" / name.base))
      left_out.push_back(fmt::format(
          "{}: one of several joints of the file, which cannot be left out alone", c.name));
    else
      drop("joints", c.name);
  }

  void operator()(const AddedPart& c) { set(Path{} / list_of(c.part) / c.name, part_json(c.part)); }
  void operator()(const ChangedPart& c) {
    const Path path = Path{} / list_of(c.after) / c.name;
    const Json before = part_json(c.before), after = part_json(c.after);
    // Of another kind: nothing of the old one means anything any more.
    if (before.value("type", Json()) != after.value("type", Json()))
      set(path, after);
    else
      merge(path, before, after);
  }
  void operator()(const RemovedPart& c) {
    edit.remove(Path{} / list_of(c.part) / c.name);
    drop(list_of(c.part), c.name);
  }

  void operator()(const AddedSpring& c) {
    const auto end = [](const Anchor& anchor, const std::string& body) {
      Json out = Json::object();
      if (!body.empty()) out["body"] = body;
      out["point"] = to_json(anchor.point);
      return out;
    };
    const Json out = {{"type", "spring"},         {"a", end(c.def.a, c.a)},
                      {"b", end(c.def.b, c.b)},   {"stiffness", c.def.stiffness},
                      {"damping", c.def.damping}, {"rest_length", c.def.rest_length}};
    set(Path{} / "forces" / c.name, out);
  }

  void operator()(const ChangedBody& c) {
    if (!has_body(c.name)) return;
    const BodyName name = split_name(c.name);
    const Path body = Path{} / "bodies" / name.base;
    const Path path = name.copy ? body / "copies" / *name.copy : body;
    const Json before = ObjectWriter::write_all(describe_body(c.before));
    Json after = ObjectWriter::write_all(describe_body(c.after));
    if (name.copy) keep_what_copies_have(c.name, before, after);
    if (after["euler_deg"] != before["euler_deg"]) {
      for (const char* other : {"orientation", "axis", "angle_deg"}) edit.remove(path / other);
      Placement place;
      place.turn(c.after.pose.q);
      if (!place.orientation) after["euler_deg"] = to_json(place.euler_deg.value_or(Vec3::Zero()));
      if (place.orientation && !name.copy) {  // copies have angles alone
        after["orientation"] = to_json(*place.orientation);
        after.erase("euler_deg");
      }
    }
    if (after["angular_velocity"] != before["angular_velocity"])
      edit.remove(path / "angular_velocity_deg");
    if (c.after.mass != c.before.mass && !c.after.mass) edit.remove(path / "mass");
    merge(path, before, after);
    const std::vector<ShapeGroup> old = shape_groups(c.before), now = shape_groups(c.after);
    for (size_t g = 0; g < std::min(old.size(), now.size()); ++g) {
      const ChangedGroup group{g, now.size(), c.before.shapes[old[g].first],
                               c.after.shapes[now[g].first]};
      if (!change_mode(c, name, group, source_of(c.before, old[g]), source_of(c.after, now[g])))
        change_shape(c, name, group);
      change_material(path, name, group);
    }
  }

  /// A shape of the file: the first of those of the body that stand for it.
  struct ChangedGroup {
    size_t index, count;  ///< which of how many
    const BodyShapeDef &before, &after;
  };

  /// True where a mesh collides in another way than before.
  bool change_mode(const ChangedBody& c, const BodyName& name, const ChangedGroup& group,
                   const std::shared_ptr<const MeshSource>& before,
                   const std::shared_ptr<const MeshSource>& after) {
    if (!before || !after || before->how.mode == after->how.mode) return false;
    const Path shape = shape_path(name, group.index);
    if (name.copy)
      left_out.push_back(fmt::format(
          "{}: what its mesh collides as is said once, in bodies.{}.shape, for all copies. To have "
          "\"{}\" for this one alone, duplicate it, delete it, and change the duplicate",
          c.name, name.base, enum_name(after->how.mode)));
    else if (!set_mode(shape, after->how.mode))
      left_out.push_back(
          fmt::format("{}: what its mesh collides as is not said in the file", c.name));
    return true;
  }

  void keep_what_copies_have(const std::string& name, const Json& before, Json& after) {
    for (const char* key : {"group", "can_sleep", "precise", "hull_mass", "inertia", "look"})
      if (after.contains(key) && before.contains(key) && after[key] != before[key]) {
        left_out.push_back(fmt::format(
            "{}: {} is common to all copies, so that one cannot have its own", name, key));
        after[key] = before[key];
      }
  }

  /// Where the file has shape number `index` of a body.
  Path shape_path(const BodyName& name, size_t index) const {
    const Path body = Path{} / "bodies" / name.base;
    if (!edit.value(body / "shape")) return at_index(body / "shapes", index);
    return index == 0 ? body / "shape" : at_index(body / "shapes", index - 1);
  }

  void change_shape(const ChangedBody& c, const BodyName& name, const ChangedGroup& group) {
    const size_t index = group.index;
    const ShapeDef &before = group.before.shape, &after = group.after.shape;
    const bool of_mesh = made_of_mesh(after.type) || group.after.source;
    for (const ShapeParameter& p : shape_entry(after.type).parameters) {
      if (number_of(before, p) == number_of(after, p)) continue;
      if (of_mesh)
        left_out.push_back(fmt::format("{}: {} is its mesh's, which other bodies may share", c.name,
                                       p.parameter.name));
      else if (name.copy)
        left_out.push_back(fmt::format(
            "{}: its shape is common to all copies, so that one cannot have its own", c.name));
      else
        set(shape_path(name, index) / p.parameter.name, number_of(after, p));
    }
    const auto place = [](const BodyShapeDef& s) { return s.source ? s.source->pose.x : s.pose.x; };
    const Vec3 from = place(group.before), to = place(group.after);
    if (!name.copy && (to - from).norm() > 1e-12 * (1 + from.norm()))
      set(shape_path(name, index) / "position", to_json(to));
    const auto mesh = [](const BodyShapeDef& s) {
      return s.source ? s.source->mesh : s.shape.mesh;
    };
    if (mesh(group.before) && mesh(group.after) && mesh(group.before) != mesh(group.after))
      scale_mesh(c, name, index, *mesh(group.before), *mesh(group.after));
  }

  /// A mesh that has grown is the file's with another `scale`.
  void scale_mesh(const ChangedBody& c, const BodyName& name, size_t index,
                  const TriangleMesh& before, const TriangleMesh& after) {
    const double factor = bounds(after).extent().norm() / bounds(before).extent().norm();
    if (std::abs(factor - 1) < 1e-12) return;
    const Path path = shape_path(name, index) / "scale";
    const auto now = edit.value(path);
    double scale = 1;
    if (now) {
      const auto [end, error] = std::from_chars(now->data(), now->data() + now->size(), scale);
      if (error != std::errc() || name.copy) {
        left_out.push_back(fmt::format("{}: its mesh has the size that the file gives", c.name));
        return;
      }
    }
    set(path, scale * factor);
  }

  /// A shape's own material is changed where the body has several shapes, else the body's. A name
  /// becomes {"like": name, ...}.
  void change_material(const Path& path, const BodyName& name, const ChangedGroup& group) {
    const auto material_of = [](const BodyShapeDef& s) {
      Material m = s.material;
      if (s.filled != 1) m.density /= s.filled;
      return ObjectWriter::write_all(describe_material(m));
    };
    const Json before = material_of(group.before);
    Json after = material_of(group.after);
    // What a division rounds is no change.
    const double was = before["density"], is = after["density"];
    if (std::abs(is - was) < 1e-12 * was) after["density"] = before["density"];
    if (before == after) return;
    const Path of_body = Path{} / "bodies" / name.base / "material";
    Path place = path / "material";
    if (!name.copy) {
      const Path shape = shape_path(name, group.index);
      if (group.count > 1 || edit.value(shape / "material")) place = shape / "material";
      const Path density = path / "density";
      if (after["density"] != before["density"] && edit.value(density)) edit.remove(density);
    }
    std::optional<std::string> base;
    for (const Path& from : {place, of_body})
      if (const auto now = edit.value(from); now && !base) base = *now;
    if (base) edit.set(place, base->starts_with('"') ? "{ \"like\": " + *base + " }" : *base);
    for (const auto& item : after.items())
      if (before[item.key()] != item.value()) set(place / item.key(), item.value());
  }
};

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> out;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    out.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

}  // namespace

std::string name_after(const std::filesystem::path& file) {
  constexpr size_t longest = 56;
  std::string name = file.stem().string().substr(0, longest);
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  for (char& c : name)
    if (!digit(c) && !letter(c)) c = '_';
  return name.empty() || digit(name[0]) ? "_" + name : name;
}

Result<SavedScene> save_edits(const std::string& text, const std::string& file,
                              std::span<const SceneEdit> edits) {
  Save save{JsonTextEdit(text), {}, {}, std::filesystem::path(file).parent_path()};
  for (const SceneEdit& e : edits) std::visit(save, e);
  const SceneRead read = read_scene(save.edit.text(), file);
  if (!read.ok()) return to_error(read.faults);
  return SavedScene{save.edit.text(), std::move(save.left_out)};
}

struct FileRemovals::State {
  Save save;
};

FileRemovals::FileRemovals(const std::string& text, std::span<const SceneEdit> before)
    : state_(std::make_unique<State>(State{{JsonTextEdit(text), {}, {}}})) {
  for (const SceneEdit& e : before) std::visit(state_->save, e);
}
FileRemovals::~FileRemovals() = default;

std::vector<TakenAlong> FileRemovals::take(const SceneEdit& removal) {
  state_->save.along.clear();
  std::visit(state_->save, removal);
  return std::move(state_->save.along);
}

const std::string& FileRemovals::text() const {
  return state_->save.edit.text();
}

std::vector<TakenAlong> taken_along(const std::string& text, std::span<const SceneEdit> before,
                                    const SceneEdit& removal) {
  return FileRemovals(text, before).take(removal);
}

std::vector<std::string> changed_lines(const std::string& before, const std::string& after) {
  const auto a = lines_of(before), b = lines_of(after);
  // Longest common subsequence of lines behind and before what is equal anyway.
  size_t head = 0, tail = 0;
  while (head < std::min(a.size(), b.size()) && a[head] == b[head]) ++head;
  while (tail < std::min(a.size(), b.size()) - head &&
         a[a.size() - 1 - tail] == b[b.size() - 1 - tail])
    ++tail;
  const size_t n = a.size() - head - tail, m = b.size() - head - tail;
  std::vector<std::vector<uint32_t>> common(n + 1, std::vector<uint32_t>(m + 1, 0));
  for (size_t i = n; i-- > 0;)
    for (size_t j = m; j-- > 0;)
      common[i][j] = a[head + i] == b[head + j] ? common[i + 1][j + 1] + 1
                                                : std::max(common[i + 1][j], common[i][j + 1]);
  std::vector<std::string> out;
  for (size_t i = 0, j = 0; i < n || j < m;) {
    if (i < n && j < m && a[head + i] == b[head + j]) {
      ++i, ++j;
    } else if (i < n && (j == m || common[i + 1][j] >= common[i][j + 1])) {
      out.push_back(fmt::format("- {}: {}", head + i + 1, a[head + i]));
      ++i;
    } else {
      out.push_back(fmt::format("+ {}: {}", head + j + 1, b[head + j]));
      ++j;
    }
  }
  return out;
}

}  // namespace tumble
