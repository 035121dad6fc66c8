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

/// "brick[3]" -> brick, 3.
struct BodyName {
  std::string base;
  std::optional<std::string> copy;
};
inline BodyName split_name(const std::string& name) {
  const size_t open = name.rfind('[');
  if (open == std::string::npos || !name.ends_with(']')) return {name, {}};
  return {name.substr(0, open), name.substr(open + 1, name.size() - open - 2)};
}

/// The text of a scene file, in which one change after the other is carried out. Changes of bodies
/// are in `file_bodies.cpp`, all others in `file_changes.cpp`.
struct FileChanges {
  using Path = JsonTextEdit::Path;

  JsonTextEdit edit;
  std::vector<std::string> left_out;  ///< what a scene file cannot say, a line each
  std::vector<TakenAlong> along;      ///< what went with something that was removed
  std::filesystem::path folder{};     ///< of the file; empty: not known

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
  /// A shape of the file: the first of those of the body that stand for it.
  struct ChangedGroup {
    size_t index, count;  ///< which of how many
    const BodyShapeDef &before, &after;
  };

  void set(const Path& path, const Json& value);
  /// Sets the members in which two objects differ; what is as by default now is removed.
  void merge(const Path& path, const Json& before, const Json& after);
  /// The same for what acts along a coordinate: a value that changes is in the one unit that is
  /// written here.
  void merge_drive(const Path& path, const Json& before, const Json& after, bool angle);
  /// Whatever names what is gone goes along.
  void drop(std::string_view list, const std::string& name);

  /// The name in the file of a mesh, which is put there unless it is there already.
  std::string name_mesh(const MeshOfBody& mesh);
  void add_mesh_body(const AddedBody& c);
  /// A copy of a body of meshes: its shapes are those of the original, word for word.
  void add_copy(const AddedBody& c, const Path& original);
  /// Where the file describes the body that a name stands for, an emitted one included.
  std::optional<Path> described(const std::string& name) const;
  /// False, and said unless an emitter made it, where the file has no such body: one of a robot,
  /// or one that could not be added.
  bool has_body(const std::string& name);
  /// Where the file has shape number `index` of a body.
  Path shape_path(const BodyName& name, size_t index) const;

  /// As what the file says that the mesh of a shape collides, with quotes; "" where it does not
  /// say.
  std::string said_mode(const Path& shape) const;
  /// As what it collides from now on; false where the file does not say that of a mesh.
  bool set_mode(const Path& shape, MeshMode mode);
  /// True where a mesh collides in another way than before.
  bool change_mode(const ChangedBody& c, const BodyName& name, const ChangedGroup& group,
                   const std::shared_ptr<const MeshSource>& before,
                   const std::shared_ptr<const MeshSource>& after);
  void change_count_of_shapes(const ChangedBody& c, const BodyName& name,
                              const std::vector<ShapeGroup>& old,
                              const std::vector<ShapeGroup>& now);
  void change_shape(const ChangedBody& c, const BodyName& name, const ChangedGroup& group);
  /// A mesh that has grown is the file's with another `scale`.
  void scale_mesh(const ChangedBody& c, const BodyName& name, size_t index,
                  const TriangleMesh& before, const TriangleMesh& after);
  /// A shape's own material is changed where the body has several shapes, else the body's. A name
  /// becomes {"like": name, ...}.
  void change_material(const Path& path, const BodyName& name, const ChangedGroup& group);
  /// Leaves values as they were that one copy of many cannot have for itself.
  void keep_what_copies_have(const std::string& name, const Json& before, Json& after);
};

}  // namespace tumble
