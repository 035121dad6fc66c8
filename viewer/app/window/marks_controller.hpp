#pragma once
#include "engine/core/result.hpp"
#include "viewer/app/scenes/camera_path.hpp"
#include "viewer/ui/time_marks.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace tumble {

/// The user's marks of a scene, stored outside of the scene's file.
struct SceneMarks {
  TimeMarks time;
  std::vector<CameraKey> flight;  ///< keys of the camera's flight, by time
  bool empty() const { return time == TimeMarks{} && flight.empty(); }
};

/// Parses the marks of a scene from the text of the user's marks file; no marks if the scene is not
/// in it. The file has times in seconds, since the length of a tick may change. Fails with what is
/// wrong.
Result<SceneMarks> read_marks(std::string_view text, const std::string& scene, double tick_seconds);
/// The text with the marks of this scene replaced and those of others unchanged; "" starts a new
/// file.
Result<std::string> with_marks(std::string_view text, const std::string& scene,
                               const SceneMarks& marks, const TickClock& clock);

/// Bookmarks, looped span and camera flight of the scene shown, kept in a file of the user from one
/// opening to the next.
class MarksController {
 public:
  /// With an empty `file`, marks are kept only while the program runs.
  explicit MarksController(std::filesystem::path file) : file_(std::move(file)) {}

  /// To be called when another scene is shown. A file that cannot be read is an error, and is not
  /// overwritten.
  Status open(const std::string& scene, double tick_seconds);
  /// To be called when the scene was saved under another name: its marks are copied to the new
  /// name.
  void go_on_as(const std::string& scene);
  const SceneMarks& marks() const { return marks_; }
  /// Times of the ticks of the scene shown; must be given every frame that is shown.
  TickClock& clock() { return clock_; }
  const TickClock& clock() const { return clock_; }
  void change(const std::function<void(SceneMarks&)>& how);
  /// Writes the marks if they have changed. A failed write is retried after the next change, or if
  /// `once_more`.
  Status keep(bool once_more = false);
  /// The tick to continue from, if the end of the looped span has been reached at this tick;
  /// returned once for each time. `generation`: SessionView::generation.
  std::optional<uint64_t> jump_back(uint64_t tick, uint64_t generation);

 private:
  Status write();

  std::filesystem::path file_;
  std::string scene_;
  TickClock clock_{1};
  SceneMarks marks_;
  std::map<std::string, SceneMarks> others_;  ///< marks of all scenes, if there is no file
  bool changed_ = false, failed_ = false, readable_ = true;
  std::optional<uint64_t> jumped_;  ///< generation of the view in which the loop last jumped back
};

}  // namespace tumble
