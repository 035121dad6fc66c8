#pragma once
#include "engine/scene/saving/dependents.hpp"
#include "viewer/ui/description_view.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

struct Frame;

/// The text of the scene's file as it is shown and changed value by value. A change that makes a
/// scene is taken at once; one that the reader refuses is kept as a draft, with what is wrong, and
/// so are those that follow, until together they make a scene: nothing that was typed is lost.
class DescriptionController {
 public:
  /// Another scene is shown.
  void forget() { *this = DescriptionController{}; }
  /// Called once a picture: `text` as the scene's file would be now, and the place that is looked
  /// at, which becomes the nearest one that is there. `world`: has what robots of the scene bring
  /// along from files of their own.
  void look(const std::string& text, ScenePath& place, const Frame& world);
  /// Null: there is no text.
  const DescriptionView* view() const { return view_.outline ? &view_ : nullptr; }

  struct Changed {
    std::string text;
    ScenePath place;                  ///< where to look at then
    std::vector<TakenAlong> along;    ///< what went with something that was left out
    std::vector<std::string> faults;  ///< of the whole text; empty: it is a scene
  };
  /// `text` with the draft and one more change. Error: this change is none.
  Result<Changed> with(const std::string& text, const std::filesystem::path& file,
                       const EditDescription& edit) const;

  /// The change that was tried makes no scene, or is to be opened first, which takes its time.
  /// `undo_steps`: how many changes of the world could be undone then.
  void keep(EditDescription edit, std::vector<std::string> faults, bool opening, size_t undo_steps);
  /// What was to be opened could not be.
  void refuse(std::vector<std::string> faults);
  bool opening() const { return view_.opening; }
  bool has_draft() const { return !draft_.empty(); }
  const std::vector<EditDescription>& draft() const { return draft_; }
  /// The newest change of the draft came after all of so many changes of the world.
  bool newer_than(size_t undo_steps) const {
    return has_draft() && undo_steps <= undo_steps_then_.back();
  }
  /// The scene was opened anew: changes of the world are counted from there, so that all of them
  /// are newer, and the names of what robots bring along are those of the new world.
  void begin_anew() {
    undo_steps_then_.assign(draft_.size(), 0);
    stale_ = true;
  }
  /// The newest change of the draft is taken back; what it was.
  std::string take_back(const std::string& text, const std::filesystem::path& file);
  /// The draft is a scene now, or is not wanted any more.
  void leave_draft();

 private:
  Result<Changed> with_draft(const std::string& text) const;

  std::vector<EditDescription> draft_;
  std::vector<size_t> undo_steps_then_;  ///< for each of the draft
  DescriptionView view_;
  std::string shown_text_;  ///< of what the outline is
  ScenePath shown_;
  bool stale_ = true;
};

}  // namespace tumble
