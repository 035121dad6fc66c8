#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/bodies/mesh_source.hpp"
#include "engine/dynamics/forces/spring.hpp"
#include "engine/dynamics/joints/joint.hpp"
#include "engine/scene/description/part.hpp"
#include "engine/scene/saving/dependents.hpp"
#include "engine/world/settings.hpp"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace tumble {

// What a person changed about a world that was made from a scene file. Bodies are named as in the
// world: "ball", "brick[3]".

/// Values, shapes and materials that differ between the two definitions.
struct ChangedBody {
  std::string name;
  BodyDef before, after;
};
/// A mesh file that a whole body is made of.
struct MeshOfBody {
  std::filesystem::path file;  ///< from the root
  double scale = 1;            ///< metres per unit of the file; its middle is the body's origin
  MeshMode mode = MeshMode::triangle_mesh;
  Material material;  ///< of all of it
};
struct AddedBody {
  BodyDef def;
  std::shared_ptr<const MeshOfBody> mesh = nullptr;  ///< null: it is of shapes alone
  /// The body of the scene that it is a copy of, which names its meshes; "" for none.
  std::string like = {};
};
struct RemovedBody {
  std::string name;
};
struct AddedJoint {
  JointDef def;
  std::string a, b;  ///< names of its bodies; "": the world
};
/// What acts along the coordinates, and what it bears before it breaks.
struct ChangedJoint {
  JointDef before, after;
};
struct RemovedJoint {
  std::string name;
};
struct AddedSpring {
  SpringDef def;
  std::string name;  ///< in the file; "" until one is given
  std::string a, b;
  ForceId id;  ///< in the world
};
struct ChangedSettings {
  WorldSettings before, after;
};
struct ChangedParameter {
  std::string name;
  double value = 0;
};
struct AddedPart {
  std::string name;
  PartDescription part;
};
struct ChangedPart {
  std::string name;
  PartDescription before, after;
};
struct RemovedPart {
  std::string name;
  PartDescription part;
};
using SceneEdit = std::variant<ChangedBody, AddedBody, RemovedBody, AddedJoint, ChangedJoint,
                               RemovedJoint, AddedSpring, ChangedSettings, ChangedParameter,
                               AddedPart, ChangedPart, RemovedPart>;

struct SavedScene {
  std::string text;
  std::vector<std::string> left_out;  ///< what a scene file cannot say, a line each
};

/// The text of the scene file with these changes, in order: a member is replaced or added for each
/// value that was changed, and everything else keeps its bytes, comments and expressions included.
/// Mesh files of added bodies are named from the folder of `file`, or from the root where that is
/// "". A body of which the file makes several is changed under its `copies`. What names a body,
/// joint or part that is removed, and cannot do without, goes with it. Error: the result would not
/// be a scene, with the fault.
Result<SavedScene> save_edits(const std::string& text, const std::string& file,
                              std::span<const SceneEdit> edits);

/// A scene's file with changes, from which one thing after the other is taken.
class FileRemovals {
 public:
  FileRemovals(const std::string& text, std::span<const SceneEdit> before);
  ~FileRemovals();
  /// What goes along.
  std::vector<TakenAlong> take(const SceneEdit& removal);
  /// What is left.
  const std::string& text() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What goes along with a removal that follows these changes.
std::vector<TakenAlong> taken_along(const std::string& text, std::span<const SceneEdit> before,
                                    const SceneEdit& removal);

/// What a body or mesh may be called in a scene after its file: letters, digits and _ alone, with
/// room for a number behind it.
std::string name_after(const std::filesystem::path& file);

}  // namespace tumble
