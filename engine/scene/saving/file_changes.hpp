#pragma once
#include "engine/scene/build/mesh_parts.hpp"
#include "engine/scene/saving/json_text_edit.hpp"
#include "engine/scene/saving/scene_edits.hpp"
#include "engine/scene/visitors/object_writer.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// The parts of a name: "brick[3]" -> brick, 3.
struct BodyName {
  std::string base;
  std::optional<std::string> copy;
};
inline BodyName split_name(const std::string& name) {
  const size_t open = name.rfind('[');
  if (open == std::string::npos || !name.ends_with(']')) return {name, {}};
  return {name.substr(0, open), name.substr(open + 1, name.size() - open - 2)};
}

/// The text of a scene file, to which changes are applied one after the other. Changes of bodies
/// are in `file_bodies.cpp`, all others in `file_changes.cpp`.
struct FileChanges {
  using Path = JsonTextEdit::Path;

  JsonTextEdit edit;
  std::vector<std::string> left_out;  ///< changes that a scene file cannot represent, one per line
  std::vector<TakenAlong> along;      ///< things removed because they depended on something removed
  std::filesystem::path folder{};     ///< folder of the file; empty: unknown

  void operator()(const ChangedSettings& c);
  void operator()(const ChangedParameter& c);
  void operator()(const AddedBody& c);
  void operator()(const ChangedBody& c);
  void operator()(const RemovedBody& c);
  void operator()(const AddedJoint& c);
  void operator()(const ChangedJoint& c);
  void operator()(const RemovedJoint& c);
  void operator()(const AddedSpring& c);
  void operator()(const AddedPart& c);
  void operator()(const ChangedPart& c);
  void operator()(const RemovedPart& c);

 private:
  /// A shape of the file, with the index of the first of the body's shapes that it stands for.
  struct ChangedGroup {
    size_t index, count;  ///< index of the shape in the file, and number of shapes
    const BodyShapeDef &before, &after;
  };

  void set(const Path& path, const Json& value);
  /// The number of items of an array of the file.
  size_t size_in_file(const Path& array) const;
  /// Sets the members in which two objects differ, and of vectors the numbers that the file says
  /// otherwise; members that have their default value now are removed.
  void merge(const Path& path, const Json& before, const Json& after);
  /// The same for a drive along a coordinate: a changed value is given in one unit only.
  void merge_drive(const Path& path, const Json& before, const Json& after, bool angle);
  /// Removes something together with all that refers to it.
  void drop(std::string_view list, const std::string& name);

  /// The name of a mesh in the file, to which it is added if necessary.
  std::string name_mesh(const MeshOfBody& mesh);
  void add_mesh_body(const AddedBody& c);
  /// Adds a copy of a body with meshes: the text of its shapes is copied from the original.
  void add_copy(const AddedBody& c, const Path& original);
  /// Path of the description of the body with this name, which may be one that an emitter copies.
  std::optional<Path> described(const std::string& name) const;
  /// Whether the file has such a body. If not (a body of a robot, or one that could not be added),
  /// this is reported, except for bodies made by emitters.
  bool has_body(const std::string& name);
  /// Path of shape number `index` of a body.
  Path shape_path(const BodyName& name, size_t index) const;

  /// The collision mode that the file gives for the mesh of a shape, with quotes; "" if it gives
  /// none.
  std::string said_mode(const Path& shape) const;
  /// Sets the collision mode of a shape; false if the file has no mesh there.
  bool set_mode(const Path& shape, MeshMode mode);
  /// Changes the collision mode if it differs; true if it did.
  bool change_mode(const ChangedBody& c, const BodyName& name, const ChangedGroup& group,
                   const std::shared_ptr<const MeshSource>& before,
                   const std::shared_ptr<const MeshSource>& after);
  void change_count_of_shapes(const ChangedBody& c, const BodyName& name,
                              const std::vector<ShapeGroup>& old,
                              const std::vector<ShapeGroup>& now);
  void change_shape(const ChangedBody& c, const BodyName& name, const ChangedGroup& group);
  /// Changes the `scale` of a mesh in the file to that of a scaled mesh.
  void scale_mesh(const ChangedBody& c, const BodyName& name, size_t index,
                  const TriangleMesh& before, const TriangleMesh& after);
  /// Changes the material of the shape if the body has several shapes, otherwise that of the body.
  /// A name becomes {"like": name, ...}.
  void change_material(const Path& path, const BodyName& name, const ChangedGroup& group);
  /// Restores in `after` values that one copy of many cannot have for itself.
  void keep_what_copies_have(const std::string& name, const Json& before, Json& after);
};

}  // namespace tumble
