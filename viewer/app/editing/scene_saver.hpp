#pragma once
#include "engine/scene/saving/scene_edits.hpp"
#include "viewer/app/editing/opening_trial.hpp"
#include "viewer/app/session/session.hpp"
#include "viewer/ui/save_preview.hpp"

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

/// The edits that a change by the user makes to the scene's file; filled and read on the simulation
/// thread.
using UndoStepEdits = std::shared_ptr<std::vector<SceneEdit>>;

/// The edits of all changes together, as soon as the simulation thread has them.
std::future<std::vector<SceneEdit>> collect_edits(Session& session,
                                                  std::vector<UndoStepEdits> undo_steps);

/// The file of a scene as it was opened.
struct SceneFile {
  std::filesystem::path path;       ///< where it will be saved
  std::filesystem::path read_from;  ///< where it was read from
  std::string text;                 ///< of the scene shown; "": it cannot be saved
  std::string on_disk;  ///< content of the file; differs from `text` if unsaved work was taken up
  std::filesystem::path pack;  ///< pack from which the scene came; empty: none
  bool ours = false;           ///< the user's own file; others are not overwritten, a copy is saved
  bool unnamed = false;        ///< a new scene, saved or not, with a name that no other scene has
};

/// Saves a scene with its changes: prepare() collects them, preview() shows them once they are
/// known, write() writes them.
class SceneSaver {
 public:
  void open(SceneFile file);
  /// `beside`: the result is test-opened on a thread of its own; otherwise in update().
  void prepare(Session& session, std::vector<UndoStepEdits> undo_steps,
               std::vector<SceneEdit> others, bool beside);
  /// Takes the changes when they have arrived.
  void update();
  /// Null until prepare() has finished.
  const SavePreview* preview() const { return preview_ ? &*preview_ : nullptr; }
  /// Sets another path to write to; the preview then warns about it.
  void name(const std::string& file);
  /// Writes what the preview shows, if it opens as a scene at that place; this becomes the scene's
  /// file. A relative path is relative to the working folder.
  Status write(const std::filesystem::path& path);
  const SceneFile& file() const { return file_; }

 private:
  void take_edits(std::vector<SceneEdit> edits);
  void look_at_trial();
  std::string warning_of(const std::filesystem::path& path) const;
  std::filesystem::path place_of(const std::filesystem::path& path) const;
  bool writes_pack(const std::filesystem::path& path) const;
  Status write_packed(const std::filesystem::path& path) const;

  SceneFile file_;
  std::vector<SceneEdit> others_;  ///< edits besides those of the changes
  std::vector<SceneEdit> edits_;   ///< all edits, as in the preview
  std::future<std::vector<SceneEdit>> collected_;
  std::optional<SavePreview> preview_;
  std::string named_;                    ///< the file that the preview warns of
  std::optional<SavePreview> tried_;     ///< what becomes the preview, if the trial goes well
  std::unique_ptr<OpeningTrial> trial_;  ///< null: none is under way
  bool beside_ = true;
  std::string text_;  ///< text to be written
};

}  // namespace tumble
