#include "engine/scene/saving/file_changes.hpp"

#include "engine/scene/saving/definition_json.hpp"
#include "engine/scene/visitors/object_writer.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

namespace tumble {
namespace {

bool list_of_objects(const Json& value) {
  return value.is_array() && !value.empty() &&
         std::ranges::all_of(value, [](const Json& item) { return item.is_object(); });
}

bool list_of_numbers(const Json& value) {
  return value.is_array() && !value.empty() &&
         std::ranges::all_of(value, [](const Json& item) { return item.is_number(); });
}

}  // namespace

void FileChanges::set(const Path& path, const Json& value) {
  if (edit.set(path, one_line(value))) return;
  left_out.push_back(fmt::format("{}: there is no place for it in the file", path.back().key));
}

size_t FileChanges::size_in_file(const Path& array) const {
  size_t count = 0;
  while (edit.value(at_index(array, count))) ++count;
  return count;
}

void FileChanges::merge(const Path& path, const Json& before, const Json& after) {
  for (const auto& item : after.items()) {
    const auto old = before.find(item.key());
    if (old != before.end() && *old == item.value()) continue;
    const Path own = path / item.key();
    const Json was = old == before.end() ? Json() : *old;
    const auto text = edit.value(own);
    const bool bracketed = text && text->starts_with('[');
    if (item.value().is_object() && (!text || text->starts_with('{')))
      merge(own, was.is_object() ? was : Json::object(), item.value());
    else if (text && list_of_objects(was) && list_of_objects(item.value()) &&
             was.size() == item.value().size() && (was.size() == 1 || bracketed))
      for (size_t i = 0; i < was.size(); ++i)  // a single one may be without brackets
        merge(bracketed ? at_index(own, i) : own, was[i], item.value()[i]);
    else if (bracketed && list_of_numbers(item.value()) &&
             size_in_file(own) == item.value().size()) {
      const bool known = was.is_array() && was.size() == item.value().size();
      for (size_t i = 0; i < item.value().size(); ++i) {
        const Path number = at_index(own, i);
        const Json said = Json::parse(*edit.value(number), nullptr, false);
        // An expression of what did not change stays; a number may be of another moment than `was`,
        // or an angle that is written in another way.
        const bool stays = known && was[i] == item.value()[i] && !said.is_number();
        if (!stays && said != item.value()[i]) set(number, item.value()[i]);
      }
    } else
      set(own, item.value());
  }
  for (const auto& item : before.items())
    if (!after.contains(item.key())) edit.remove(path / item.key());
}

void FileChanges::operator()(const ChangedSettings& c) {
  merge(Path{} / "settings", write_all(c.before), write_all(c.after));
}

void FileChanges::operator()(const ChangedParameter& c) {
  const Path path = Path{} / "parameters" / c.name;
  const auto now = edit.value(path);
  set(now && now->starts_with('{') ? path / "value" : path, c.value);
}

void FileChanges::drop(std::string_view list, const std::string& name) {
  std::ranges::move(drop_dependents(edit, list, name), std::back_inserter(along));
}

void FileChanges::operator()(const AddedJoint& c) {
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

void FileChanges::operator()(const ChangedJoint& c) {
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

void FileChanges::merge_drive(const Path& path, const Json& before, const Json& after, bool angle) {
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

void FileChanges::operator()(const RemovedJoint& c) {
  const BodyName name = split_name(c.name);
  if (name.copy || !edit.remove(Path{} / "joints" / name.base))
    left_out.push_back(fmt::format(
        "{}: one of several joints of the file, which cannot be left out alone", c.name));
  else
    drop("joints", c.name);
}

void FileChanges::operator()(const AddedPart& c) {
  set(Path{} / list_of(c.part) / c.name, part_json(c.part));
}

void FileChanges::operator()(const ChangedPart& c) {
  const Path path = Path{} / list_of(c.after) / c.name;
  const Json before = part_json(c.before), after = part_json(c.after);
  // For another kind, nothing of the old value has a meaning.
  if (before.value("type", Json()) != after.value("type", Json()))
    set(path, after);
  else
    merge(path, before, after);
}

void FileChanges::operator()(const RemovedPart& c) {
  edit.remove(Path{} / list_of(c.part) / c.name);
  drop(list_of(c.part), c.name);
}

void FileChanges::operator()(const AddedSpring& c) {
  const auto end = [](const Anchor& anchor, const std::string& body) {
    Json out = Json::object();
    if (!body.empty()) out["body"] = body;
    out["point"] = to_json(anchor.point);
    return out;
  };
  SpringDef def = c.def;  // a copy, since the references to its leaves are not const
  Json out = {{"type", "spring"},
              {"a", end(def.a, c.a)},
              {"b", end(def.b, c.b)},
              {"stiffness", to_json(Leaf(&def.stiffness))},
              {"damping", to_json(Leaf(&def.damping))},
              {"rest_length", to_json(Leaf(&def.rest_length))}};
  if (def.cable_radius != 0) out["cable_radius"] = def.cable_radius;
  set(Path{} / "forces" / c.name, out);
}

}  // namespace tumble
