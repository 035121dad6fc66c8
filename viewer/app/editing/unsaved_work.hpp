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

/// Folder for unsaved work: tumble/unsaved under $XDG_STATE_HOME, or ~/.local/state (XDG Base
/// Directory Specification); empty if neither is known.
std::filesystem::path unsaved_folder();

/// The n-th name of a new scene in the working folder: "untitled.json", "untitled_2.json" ...
std::filesystem::path unnamed_scene(int n);

/// Changes to a scene that are not in its file: collected soon after every change, and kept in a
/// file of their own until they are saved or discarded, so that they survive a crash. Each running
/// program uses files of its own, so that several windows can show one scene.
class UnsavedWork {
 public:
  /// `folder`: where such files are kept; empty: nowhere.
  explicit UnsavedWork(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// To be called when another scene is shown; what was kept of the last one stays. `goes_on`: it
  /// is the same scene with another text, which replaces what is kept.
  void open(const SceneFile& file, bool goes_on);
  /// Unsaved work on this scene left by an earlier run or by this one; empty if it is equal to the
  /// scene's file.
  struct Kept {
    std::string text;
    std::string when;            ///< for display, local time
    std::filesystem::path file;  ///< where it is kept
    bool own = false;            ///< left by this run
    bool older = false;          ///< the scene's file was written after it
  };
  std::optional<Kept> kept() const;
  /// Continues kept work: from now on it belongs to this run.
  void take_over(const Kept& kept);
  /// Kept work on new scenes that have no file yet.
  struct Unnamed {
    std::filesystem::path path;  ///< the path that it would be saved to
    Kept kept;
  };
  std::vector<Unnamed> kept_unnamed() const;
  /// An unused name for a new scene: of no file, of no kept work, and not of the scene shown if
  /// that has work to be kept.
  std::filesystem::path free_name() const;
  /// To be called when changes were made, undone or continued.
  void note() { stale_ = true; }
  /// To be called after note() where the scene's text with the change is known before the session
  /// has answered: text() is that one until then, and it is kept at once.
  void expect(std::string text);
  /// The same as note() where what was expected does not hold any more, after undo and redo.
  void look_again();
  /// To be called once per picture, with the changes in effect: after note() they are applied to
  /// the file's text.
  void update(Session& session, const std::vector<UndoStepEdits>& undo_steps, double dt);
  /// Whether edits() are those of all changes.
  bool known() const { return file_.text.empty() || (!stale_ && !collected_.valid()); }
  /// The next update() collects the newest changes.
  void hurry();
  /// Collects the newest changes at once, before another scene is shown. `own_thread`: whether the
  /// session has one.
  void finish(Session& session, const std::vector<UndoStepEdits>& undo_steps, bool own_thread);
  /// The text of the scene after each of these changes, which come after those that are `too_old`
  /// to be undone; empty if the session does not answer soon. A change that the file cannot
  /// represent leaves the text as it is.
  std::vector<std::string> texts_after(const std::string& start, Session& session,
                                       const std::vector<UndoStepEdits>& too_old,
                                       const std::vector<UndoStepEdits>& undo_steps,
                                       bool own_thread) const;
  /// To be called when the scene was saved: this is its file from now on.
  void saved(const SceneFile& file);
  /// Discards kept work.
  void throw_away(const std::filesystem::path& kept);
  bool any() const { return expected_ ? *expected_ != file_.on_disk : any_; }
  /// The scene's text with the changes; the file's own text if there are none, or if they cannot be
  /// represented in it.
  const std::string& text() const { return expected_ ? *expected_ : text_; }
  /// `theirs`, which somebody else wrote into the file, with the changes too: they are made to that
  /// text value by value, or line by line where they are in the text that was opened. Error: it is
  /// no scene, or both have changed the same lines.
  Result<std::string> with(const std::string& theirs) const;
  /// The edits since the scene was opened, as last collected.
  const std::vector<SceneEdit>& edits() const { return edits_; }

 private:
  using Files = std::vector<std::filesystem::path>;
  void ask(Session& session, const std::vector<UndoStepEdits>& undo_steps);
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
  std::filesystem::path taken_;    ///< file that the next scene to be opened continues
  /// Locks of all files in which this run keeps work, for all scenes it has shown.
  std::map<std::filesystem::path, ProcessLock> held_;
  SceneFile file_;
  std::string text_;
  std::string kept_text_;                ///< what is in `keep_in_`; "": nothing
  std::optional<std::string> expected_;  ///< the text, before the newest change was collected
  bool expected_asked_ = false;          ///< the newest question was sent after that change
  std::vector<SceneEdit> edits_;
  bool stale_ = false;  ///< the changes are not those collected last
  double since_ = 0;    ///< time since the last collection [s]
  bool any_ = false;
  bool opened_changed_ = false;  ///< the text that was opened was not the file's
  std::future<std::vector<SceneEdit>> collected_;
};

}  // namespace tumble
