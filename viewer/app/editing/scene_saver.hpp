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

/// What a deed changes about the file of the scene; filled and read on the simulation thread.
using DeedEdits = std::shared_ptr<std::vector<SceneEdit>>;

/// What deeds change, all together, as soon as the simulation thread has it.
std::future<std::vector<SceneEdit>> collect_edits(Session& session, std::vector<DeedEdits> deeds);

/// The file of a scene as it was opened.
struct SceneFile {
  std::filesystem::path path;       ///< where saving goes
  std::filesystem::path read_from;  ///< where it was read
  std::string text;                 ///< of what is shown; "": nothing that could be saved
  std::string on_disk;              ///< what it holds; another text where unsaved work was taken up
  std::filesystem::path pack;       ///< the scene came out of this pack; empty: out of none
  bool ours = false;     ///< a person's own file; others stay as they are, and get a copy
  bool unnamed = false;  ///< a new scene: it is called as no other is, saved or not
};

/// Saves a scene with what was changed since it was opened: prepare() collects the changes, a
/// preview is shown as soon as they are known, write() writes it.
class SceneSaver {
 public:
  void open(SceneFile file);
  /// `beside`: what would be written is tried out on a thread of its own; else in update().
  void prepare(Session& session, std::vector<DeedEdits> deeds, std::vector<SceneEdit> others,
               bool beside);
  /// Takes the changes that have come.
  void update();
  /// Null until prepare() has an answer.
  const SavePreview* preview() const { return preview_ ? &*preview_ : nullptr; }
  /// Somebody names another file to be written: the preview warns of what that would do.
  void name(const std::string& file);
  /// Writes what the preview shows, if it opens as a scene there; from then on that is the scene's
  /// file. A relative path is one of the working folder.
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
  std::vector<SceneEdit> others_;  ///< besides the deeds
  std::vector<SceneEdit> edits_;   ///< all of them, as the preview has them
  std::future<std::vector<SceneEdit>> collected_;
  std::optional<SavePreview> preview_;
  std::string named_;                    ///< the file that the preview warns of
  std::optional<SavePreview> tried_;     ///< what becomes the preview, if the trial goes well
  std::unique_ptr<OpeningTrial> trial_;  ///< null: none is under way
  bool beside_ = true;
  std::string text_;  ///< of the preview
};

}  // namespace tumble
