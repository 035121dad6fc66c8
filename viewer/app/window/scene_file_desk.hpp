#pragma once
#include "viewer/app/editing/scene_saver.hpp"
#include "viewer/app/window/file_watch.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// The file of the scene that is shown: saved by a person, changed by others.
class SceneFileDesk {
 public:
  void open(const SceneFile& file) {
    saver_.open(file);
    watch_.open(file.read_from, file.on_disk);
  }
  /// Somebody wants to see what saving would write: see SceneSaver.
  void prepare(Session& session, std::vector<DeedEdits> deeds, std::vector<SceneEdit> others,
               bool beside) {
    named_ = false;
    saver_.prepare(session, std::move(deeds), std::move(others), beside);
  }
  /// Called once a picture. Where it would go is proposed in `name`; from then on a person says.
  void update(std::string& name) {
    saver_.update();
    if (!saver_.preview()) return;
    if (!std::exchange(named_, true)) name = saver_.preview()->file;
    saver_.name(name);
  }
  /// Null: nothing was prepared, or it is not known yet.
  const SavePreview* preview() const { return saver_.preview(); }
  /// From then on that is the scene's file, and watched. What was unpacked is nobody's to change.
  Status write(const std::string& name) {
    if (name.empty()) return Error{ErrorCode::invalid_argument, "a name is missing", {}, {}};
    if (Status done = saver_.write(name); !done) return done;
    watch_.open(file().pack.empty() ? file().path : std::filesystem::path(), file().on_disk);
    return {};
  }
  const SceneFile& file() const { return saver_.file(); }
  /// What somebody else has written into it, once.
  std::optional<std::string> changed_by_others(double dt) { return watch_.look(dt); }
  /// Somebody else has taken it away, once.
  bool taken_away() { return watch_.take_gone(); }

 private:
  SceneSaver saver_;
  bool named_ = false;
  FileWatch watch_;
};

}  // namespace tumble
