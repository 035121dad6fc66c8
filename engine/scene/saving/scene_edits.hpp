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
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace tumble {

// Changes by the user to a world that was made from a scene file. Bodies are named as in the world:
// "ball", "brick[3]".

/// A key of a body as the file is to say it, word for word: a definition has a course or a drawn
/// shape in another form than that in which it was written.
struct WrittenKey {
  std::string key;
  std::optional<std::string> text;  ///< JSON; none: the key is left out
};
/// Values, shapes and materials that differ between the two definitions.
struct ChangedBody {
  std::string name;
  BodyDef before, after;
  std::vector<WrittenKey> written = {};  ///< keys that are not taken from the definitions
};
/// A mesh file from which a whole body is made.
struct MeshOfBody {
  std::filesystem::path file;  ///< absolute path
  double scale = 1;  ///< metres per unit of the file; the centre of its bounds is the body's origin
  MeshMode mode = MeshMode::triangle_mesh;
  Material material;  ///< of all its shapes
};
struct AddedBody {
  BodyDef def;
  std::shared_ptr<const MeshOfBody> mesh = nullptr;  ///< null: the body has no mesh file
  /// The body of the scene from which it was copied, whose meshes the file names; "" for none.
  std::string like = {};
};
struct RemovedBody {
  std::string name;
};
struct AddedJoint {
  JointDef def;
  std::string a, b;  ///< names of its bodies; "": the world
};
/// Changes of the drives along the coordinates, and of the strength of a joint.
struct ChangedJoint {
  JointDef before, after;
};
struct RemovedJoint {
  std::string name;
};
struct AddedSpring {
  SpringDef def;
  std::string name;  ///< in the file; "" until it gets one
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
  std::vector<std::string> left_out;  ///< changes that a scene file cannot represent, one per line
};

/// The text of the scene file with these changes, applied in order: a member is replaced or added
/// for each value that was changed, and everything else keeps its bytes, comments and expressions
/// included. Mesh files of added bodies are given relative to the folder of `file`, or absolutely
/// if that is "". A body that the file makes by a repetition is changed under its `copies`.
/// Whatever refers to a removed body, joint or part and cannot do without it is removed too. Error:
/// the result would not be a valid scene, with its fault.
Result<SavedScene> save_edits(const std::string& text, const std::string& file,
                              std::span<const SceneEdit> edits);

/// A scene's file with changes, from which things are removed one after the other.
class FileRemovals {
 public:
  FileRemovals(const std::string& text, std::span<const SceneEdit> before);
  ~FileRemovals();
  /// Applies a removal; returns what was removed because it depended on it.
  std::vector<TakenAlong> take(const SceneEdit& removal);
  /// The remaining text.
  const std::string& text() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What would be removed because it depends on a removal that follows these changes.
std::vector<TakenAlong> taken_along(const std::string& text, std::span<const SceneEdit> before,
                                    const SceneEdit& removal);

/// A name for a body or mesh, from that of its file: letters, digits and _ only, and short enough
/// for an appended number.
std::string name_after(const std::filesystem::path& file);

}  // namespace tumble
