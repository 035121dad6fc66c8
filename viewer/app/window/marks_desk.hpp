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

/// What a person marked of a scene besides the scene itself.
struct SceneMarks {
  TimeMarks time;
  std::vector<CameraKey> flight;  ///< of the camera, by time
  bool empty() const { return time == TimeMarks{} && flight.empty(); }
};

/// What the text of the file that keeps them has of a scene; nothing where that is not in it. Times
/// are seconds there: a tick may be another one tomorrow. Fails with what is wrong.
Result<SceneMarks> read_marks(std::string_view text, const std::string& scene, double tick_seconds);
/// The text with these of a scene, those of the others as they were; "": of a new file.
Result<std::string> with_marks(std::string_view text, const std::string& scene,
                               const SceneMarks& marks, const TickClock& clock);

/// Bookmarks, looped span and flight of the scene that is shown, kept from one opening to the next
/// in a file of the user.
class MarksDesk {
 public:
  /// `file`: empty keeps them as long as the program runs.
  explicit MarksDesk(std::filesystem::path file) : file_(std::move(file)) {}

  /// Another scene is shown. A file that cannot be read is a fault, and is not written over.
  Status open(const std::string& scene, double tick_seconds);
  /// The scene has another name from now on, as its file was saved elsewhere: its marks come along,
  /// and those under the earlier name stay.
  void go_on_as(const std::string& scene);
  const SceneMarks& marks() const { return marks_; }
  /// Of the scene that is shown; it is to see every moment.
  TickClock& clock() { return clock_; }
  const TickClock& clock() const { return clock_; }
  void change(const std::function<void(SceneMarks&)>& how);
  /// Writes what was changed, if anything was. What could not be written is tried again after the
  /// next change, or when asked `once_more`.
  Status keep(bool once_more = false);
  /// Where the loop goes on from, once its end is reached at this tick of this course of history;
  /// asks once for each time.
  std::optional<uint64_t> jump_back(uint64_t tick, uint64_t generation);

 private:
  Status write();

  std::filesystem::path file_;
  std::string scene_;
  TickClock clock_{1};
  SceneMarks marks_;
  std::map<std::string, SceneMarks> others_;  ///< where there is no file
  bool changed_ = false, failed_ = false, readable_ = true;
  std::optional<uint64_t> jumped_;  ///< in this generation
};

}  // namespace tumble
