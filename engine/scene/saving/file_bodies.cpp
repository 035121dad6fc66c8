#include "engine/geometry/triangle_mesh.hpp"
#include "engine/scene/build/describe_body.hpp"
#include "engine/scene/build/mesh_parts.hpp"
#include "engine/scene/saving/definition_json.hpp"
#include "engine/scene/saving/file_changes.hpp"
#include "engine/scene/visitors/object_writer.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// A path relative to a folder, resolved as the file system does: ".." from a linked folder leads
/// to the parent of its target.
std::filesystem::path relative_name(const std::filesystem::path& file,
                                    const std::filesystem::path& folder) {
  std::error_code none;
  const auto there = std::filesystem::weakly_canonical(file.parent_path(), none);
  const auto here = std::filesystem::weakly_canonical(folder, none);
  if (there.empty() || here.empty()) return file.lexically_relative(folder);
  return (there / file.filename()).lexically_relative(here);
}

}  // namespace

std::string FileChanges::name_mesh(const MeshOfBody& mesh) {
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

void FileChanges::add_mesh_body(const AddedBody& c) {
  BodyDef shapeless = c.def;
  shapeless.shapes.clear();
  Json body = body_json(shapeless);
  body.erase("shapes");
  body["shape"] = {{"type", "mesh"}, {"mesh", name_mesh(*c.mesh)}};
  if (c.mesh->mode != MeshMode::triangle_mesh)
    body["shape"]["mode"] = std::string(enum_name(c.mesh->mode));
  put_material(body, c.mesh->material);
  set(Path{} / "bodies" / c.def.name, body);
}

std::optional<FileChanges::Path> FileChanges::described(const std::string& name) const {
  const std::string base = split_name(name).base;
  const Path body = Path{} / "bodies" / base;
  if (edit.value(body)) return body;
  const auto emitted = edit.value(Path{} / "emitters" / base / "body");
  if (!emitted || !emitted->starts_with('"') || emitted->size() < 2) return std::nullopt;
  const Path source = Path{} / "bodies" / emitted->substr(1, emitted->size() - 2);
  return edit.value(source) ? std::optional(source) : std::nullopt;
}

void FileChanges::add_copy(const AddedBody& c, const Path& original) {
  BodyDef shapeless = c.def;
  shapeless.shapes.clear();
  shapeless.drawn.clear();
  Json body = body_json(shapeless);
  body.erase("shapes");
  const Path own = Path{} / "bodies" / c.def.name;
  set(own, body);
  const BodyName name = split_name(c.like);
  for (const char* key : {"shape", "shapes", "material", "density", "drawn"}) {
    auto text = edit.value(original / key);
    // A copy of a repetition may have a material of its own.
    if (name.copy)
      if (const auto single = edit.value(original / "copies" / *name.copy / key)) text = single;
    if (text && !edit.set(own / key, std::string(*text)))
      left_out.push_back(fmt::format("{}: there is no place for its {}", c.def.name, key));
  }
  // The body may have been changed to another collision mode than the file has.
  const std::vector<ShapeGroup> groups = shape_groups(c.def);
  for (size_t g = 0; g < groups.size(); ++g)
    if (const auto source = source_of(c.def, groups[g]))
      set_mode(shape_path({c.def.name, {}}, g), source->how.mode);
}

std::string FileChanges::said_mode(const Path& shape) const {
  const auto type = edit.value(shape / "type"), mesh = edit.value(shape / "mesh");
  if (type == "\"convex_hull\"") return mesh ? "\"convex_hull\"" : "";
  if (type == "\"triangle_mesh\"") return std::string(*type);
  if (type != "\"mesh\"") return {};
  if (const auto own = edit.value(shape / "mode")) return std::string(*own);
  if (!mesh || mesh->size() < 2) return {};
  const Path entry = Path{} / "meshes" / mesh->substr(1, mesh->size() - 2);
  return std::string(edit.value(entry / "mode").value_or("\"triangle_mesh\""));
}

bool FileChanges::set_mode(const Path& shape, MeshMode mode) {
  const std::string now = said_mode(shape);
  if (now.empty()) return false;
  if (now == fmt::format("\"{}\"", enum_name(mode))) return true;
  set(shape / "type", "mesh");
  set(shape / "mode", std::string(enum_name(mode)));
  for (const char* of_old : {"concavity", "pieces", "cell", "error"}) edit.remove(shape / of_old);
  return true;
}

void FileChanges::operator()(const AddedBody& c) {
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

bool FileChanges::has_body(const std::string& name) {
  const BodyName parts = split_name(name);
  const Path body = Path{} / "bodies" / parts.base;
  if (edit.value(parts.copy ? body / "repeat" : body)) return true;
  if (!parts.copy || !edit.value(Path{} / "emitters" / parts.base))
    left_out.push_back(fmt::format("{}: it is not among the bodies of the file", name));
  return false;
}

void FileChanges::operator()(const RemovedBody& c) {
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

void FileChanges::operator()(const ChangedBody& c) {
  if (!has_body(c.name)) return;
  const BodyName name = split_name(c.name);
  const Path body = Path{} / "bodies" / name.base;
  const Path path = name.copy ? body / "copies" / *name.copy : body;
  const Json before = write_all(describe_body(c.before));
  Json after = write_all(describe_body(c.after));
  if (name.copy) keep_what_copies_have(c.name, before, after);
  if (after["euler_deg"] != before["euler_deg"]) {
    for (const char* other : {"orientation", "axis", "angle_deg"}) edit.remove(path / other);
    Placement place;
    place.turn(c.after.pose.q);
    if (!place.orientation) after["euler_deg"] = to_json(place.euler_deg.value_or(Vec3::Zero()));
    if (place.orientation && !name.copy) {  // copies can only have angles
      after["orientation"] = to_json(*place.orientation);
      after.erase("euler_deg");
    }
  }
  if (after["angular_velocity"] != before["angular_velocity"])
    edit.remove(path / "angular_velocity_deg");
  if (c.after.mass != c.before.mass && !c.after.mass) edit.remove(path / "mass");
  merge(path, before, after);
  for (const WrittenKey& own : c.written)
    own.text ? edit.set(path / own.key, *own.text) : edit.remove(path / own.key);
  const std::vector<ShapeGroup> old = shape_groups(c.before), now = shape_groups(c.after);
  if (old.size() != now.size()) return change_count_of_shapes(c, name, old, now);
  for (size_t g = 0; g < std::min(old.size(), now.size()); ++g) {
    const ChangedGroup group{g, now.size(), c.before.shapes[old[g].first],
                             c.after.shapes[now[g].first]};
    if (!change_mode(c, name, group, source_of(c.before, old[g]), source_of(c.after, now[g])))
      change_shape(c, name, group);
    change_material(path, name, group);
  }
}

bool FileChanges::change_mode(const ChangedBody& c, const BodyName& name, const ChangedGroup& group,
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

void FileChanges::keep_what_copies_have(const std::string& name, const Json& before, Json& after) {
  for (const char* key : {"group", "can_sleep", "precise", "hull_mass", "inertia", "look"})
    if (after.contains(key) && before.contains(key) && after[key] != before[key]) {
      std::string words = key;
      std::ranges::replace(words, '_', ' ');
      left_out.push_back(fmt::format(
          "{}: {} is common to all copies, so that one cannot have its own", name, words));
      after[key] = before[key];
    }
}

/// Shapes that are equal at the beginning and at the end of the list stay; those between are
/// removed, and the new ones are appended.
void FileChanges::change_count_of_shapes(const ChangedBody& c, const BodyName& name,
                                         const std::vector<ShapeGroup>& old,
                                         const std::vector<ShapeGroup>& now) {
  if (name.copy) {
    left_out.push_back(fmt::format(
        "{}: its shapes are common to all copies, so that one cannot have its own", c.name));
    return;
  }
  const auto same = [&](const ShapeGroup& a, const ShapeGroup& b) {
    const BodyShapeDef &p = c.before.shapes[a.first], &q = c.after.shapes[b.first];
    return p.source == q.source && p.shape.mesh == q.shape.mesh && shape_json(p) == shape_json(q) &&
           material_json(p.material) == material_json(q.material);
  };
  size_t first = 0, last = 0;
  const size_t least = std::min(old.size(), now.size());
  while (first < least && same(old[first], now[first])) ++first;
  while (first + last < least && same(old[old.size() - 1 - last], now[now.size() - 1 - last]))
    ++last;
  const Path body = Path{} / "bodies" / name.base;
  for (size_t g = old.size() - last; g-- > first;) edit.remove(shape_path(name, g));
  if (edit.value(body / "shapes") && !edit.value(at_index(body / "shapes", 0)))
    edit.remove(body / "shapes");
  for (size_t g = first; g < now.size() - last; ++g) {
    const BodyShapeDef& part = c.after.shapes[now[g].first];
    if (made_of_mesh(part.shape.type) || part.source) {
      left_out.push_back(fmt::format("{}: the file of a mesh that was added is not known", c.name));
      continue;
    }
    Json shape = shape_json(part);
    // Same material as the other shapes of this body.
    const bool alike =
        g > 0 && material_json(part.material) == material_json(c.after.shapes[0].material);
    if (!alike || edit.value(shape_path(name, 0) / "material"))
      shape["material"] = material_json(part.material);
    // A single shape has the key "shape", several have "shapes".
    if (const auto only = edit.value(body / "shape")) {
      edit.set(body / "shape", "[" + std::string(*only) + "]");
      edit.rename(body / "shape", "shapes");
    }
    if (!edit.append(body / "shapes", one_line(shape)))
      set(body / "shapes", Json::array({std::move(shape)}));
  }
}

FileChanges::Path FileChanges::shape_path(const BodyName& name, size_t index) const {
  const Path body = Path{} / "bodies" / name.base;
  if (!edit.value(body / "shape")) return at_index(body / "shapes", index);
  return index == 0 ? body / "shape" : at_index(body / "shapes", index - 1);
}

void FileChanges::change_shape(const ChangedBody& c, const BodyName& name,
                               const ChangedGroup& group) {
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
  if (!name.copy && !of_mesh && !(group.before.pose.q.coeffs() == group.after.pose.q.coeffs())) {
    const Path shape = shape_path(name, index);
    for (const char* key : {"orientation", "axis", "angle_deg", "euler_deg"})
      edit.remove(shape / key);
    Placement turned;
    turned.turn(group.after.pose.q);
    if (turned.euler_deg) set(shape / "euler_deg", to_json(*turned.euler_deg));
    if (turned.orientation) set(shape / "orientation", to_json(*turned.orientation));
  }
  const auto mesh = [](const BodyShapeDef& s) { return s.source ? s.source->mesh : s.shape.mesh; };
  if (mesh(group.before) && mesh(group.after) && mesh(group.before) != mesh(group.after))
    scale_mesh(c, name, index, *mesh(group.before), *mesh(group.after));
}

void FileChanges::scale_mesh(const ChangedBody& c, const BodyName& name, size_t index,
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

void FileChanges::change_material(const Path& path, const BodyName& name,
                                  const ChangedGroup& group) {
  const auto material_of = [](const BodyShapeDef& s) {
    Material m = s.material;
    if (s.filled != 1) m.density /= s.filled;
    return write_all(describe_material(m));
  };
  const Json before = material_of(group.before);
  Json after = material_of(group.after);
  // A difference from rounding a division is not a change.
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

}  // namespace tumble
