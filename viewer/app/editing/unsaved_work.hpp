#pragma once
#include "viewer/app/editing/process_lock.hpp"
#include "viewer/app/editing/scene_saver.hpp"
#include "viewer/app/session/session.hpp"

#include <filesystem>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Where unsaved work is kept: tumble/unsaved under $XDG_STATE_HOME, or ~/.local/state (XDG Base
/// Directory Specification); empty where neither is known.
std::filesystem::path unsaved_folder();

/// The n-th name of a new scene in the working folder: "untitled.json", "untitled_2.json" ...
std::filesystem::path unnamed_scene(int n);

/// What was changed about the scene's file and is not in it: known soon after every deed, and kept
/// in a file of its own until it is saved or thrown away, so that it outlives a crash. Each running
/// program keeps what it has done to a scene in a file that no other touches: several windows may
/// show one scene.
class UnsavedWork {
 public:
  /// `folder`: where such files are; empty: none are written.
  explicit UnsavedWork(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Another scene is shown; what was kept of the last one stays. `goes_on`: it is the same one
  /// with another text, and what is kept of it becomes that.
  void open(const SceneFile& file, bool goes_on);
  /// Work that was left of this scene, by an earlier run or by this one, and when; nothing when
  /// that is what the scene's file holds, too.
  struct Kept {
    std::string text;
    std::string when;            ///< for people, local time
    std::filesystem::path file;  ///< where it is kept
    bool own = false;            ///< this run has left it
  };
  std::optional<Kept> kept() const;
  /// Somebody goes on with what was kept: from now on it is this run's.
  void take_over(const Kept& kept);
  /// Work that was kept of other new scenes, which have no file yet.
  struct Unnamed {
    std::filesystem::path path;  ///< as they would be called
    Kept kept;
  };
  std::vector<Unnamed> kept_unnamed() const;
  /// What a new scene is called: as no file, no work that was kept, and not as the scene that is
  /// shown where work of that is still to be kept.
  std::filesystem::path free_name() const;
  /// Deeds have come, gone, or gone on.
  void note() { stale_ = true; }
  /// Called once a picture with the deeds that hold: after note() they are put into the file's
  /// text.
  void update(Session& session, const std::vector<DeedEdits>& deeds, double dt);
  /// Looks at the newest deeds at once, before another scene is shown. `own_thread`: of the
  /// session.
  void finish(Session& session, const std::vector<DeedEdits>& deeds, bool own_thread);
  /// A text of the scene after each of these deeds, which come after those that are too old;
  /// nothing where the session does not say it soon. What cannot be said in the file leaves it as
  /// it is.
  std::vector<std::string> texts_after(const std::string& start, Session& session,
                                       const std::vector<DeedEdits>& too_old,
                                       const std::vector<DeedEdits>& deeds, bool own_thread) const;
  /// The scene was saved: this is its file from now on.
  void saved(const SceneFile& file);
  /// Nobody wants what was kept.
  void throw_away(const std::filesystem::path& kept);
  bool any() const { return any_; }
  /// The scene with what was changed; the file's own text when nothing was, or when the changes
  /// cannot be said in it.
  const std::string& text() const { return text_; }
  /// The changes of the deeds since the scene was opened, as they were last looked at.
  const std::vector<SceneEdit>& edits() const { return edits_; }

 private:
  using Files = std::vector<std::filesystem::path>;
  void take(std::vector<SceneEdit> edits);
  std::optional<std::string> text_with(const std::string& text,
                                       const std::vector<SceneEdit>& edits) const;
  void keep();
  bool is_of_scene(const std::filesystem::path& kept) const;
  void claim_file();
  std::filesystem::path kept_file_of(const std::filesystem::path& scene, int place) const;
  Files kept_files_of(const std::filesystem::path& scene) const;
  bool is_anothers(const std::filesystem::path& kept) const;
  std::optional<Kept> read_kept(const std::filesystem::path& kept) const;

  std::filesystem::path folder_;
  std::filesystem::path keep_in_;  ///< empty: nothing was kept yet
  std::filesystem::path taken_;    ///< what the next scene that is opened goes on with
  /// The files in which this run keeps work, of all scenes that it has shown.
  std::map<std::filesystem::path, ProcessLock> held_;
  SceneFile file_;
  std::string text_;
  std::vector<SceneEdit> edits_;
  bool stale_ = false;  ///< deeds are others than those looked at
  double since_ = 0;    ///< the last look [s]
  bool any_ = false;
  std::future<std::vector<SceneEdit>> collected_;
};

}  // namespace tumble
