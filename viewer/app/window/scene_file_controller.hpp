#pragma once
#include "viewer/app/editing/scene_saver.hpp"
#include "viewer/app/window/file_watch.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// The file of the scene shown: saved by the user, changed by other programs.
class SceneFileController {
 public:
  void open(const SceneFile& file) {
    saver_.open(file);
    watch_.open(file.read_from, file.on_disk);
    others_.reset();
  }
  /// Prepares a preview of what saving would write: see SceneSaver.
  void prepare(Session& session, std::vector<UndoStepEdits> undo_steps,
               std::vector<SceneEdit> others, bool beside) {
    named_ = false;
    saver_.prepare(session, std::move(undo_steps), std::move(others), beside);
  }
  /// To be called once per picture. Sets `name` to the proposed path once; later the user may
  /// change it.
  void update(std::string& name) {
    saver_.update();
    if (!saver_.preview()) return;
    if (!std::exchange(named_, true)) name = saver_.preview()->file;
    saver_.name(name);
  }
  /// Null: no preview was requested, or it is not ready yet.
  const SavePreview* preview() const { return saver_.preview(); }
  /// Writes the file, which becomes the scene's file and is watched. Files unpacked from a pack are
  /// not watched, since nobody is to edit them.
  Status write(const std::string& name) {
    if (name.empty()) return Error{ErrorCode::invalid_argument, "a name is missing", {}, {}};
    if (Status done = saver_.write(name); !done) return done;
    watch_.open(file().pack.empty() ? file().path : std::filesystem::path(), file().on_disk);
    others_.reset();
    return {};
  }
  const SceneFile& file() const { return saver_.file(); }
  /// New text written by another program; none: there is none, or it was taken.
  const std::optional<std::string>& changed_by_others(double dt) {
    if (auto text = watch_.look(dt)) others_ = std::move(text);
    return others_;
  }
  std::string take_changed_by_others() { return *std::exchange(others_, std::nullopt); }
  /// Whether another program has removed the file, once.
  bool taken_away() { return watch_.take_gone(); }

 private:
  SceneSaver saver_;
  bool named_ = false;
  FileWatch watch_;
  std::optional<std::string> others_;  ///< written by another program, and not taken yet
};

}  // namespace tumble
