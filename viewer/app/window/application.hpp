#pragma once
#include "viewer/app/editing/description_controller.hpp"
#include "viewer/app/editing/opening_trial.hpp"
#include "viewer/app/editing/removal.hpp"
#include "viewer/app/session/shown_settings.hpp"
#include "viewer/app/session/shown_world.hpp"
#include "viewer/app/window/canvas.hpp"
#include "viewer/app/window/comparison_controller.hpp"
#include "viewer/app/window/editing_tools.hpp"
#include "viewer/app/window/instruments.hpp"
#include "viewer/app/window/lent_overlays.hpp"
#include "viewer/app/window/marks_controller.hpp"
#include "viewer/app/window/mouse_pull.hpp"
#include "viewer/app/window/picture_layout.hpp"
#include "viewer/app/window/pointer.hpp"
#include "viewer/app/window/preferences.hpp"
#include "viewer/app/window/question_controller.hpp"
#include "viewer/app/window/replay_controller.hpp"
#include "viewer/app/window/scene_camera.hpp"
#include "viewer/app/window/scene_file_controller.hpp"
#include "viewer/app/window/scene_opening.hpp"
#include "viewer/app/window/screenshots.hpp"
#include "viewer/app/window/thumbnails.hpp"
#include "viewer/app/window/undo_manager.hpp"
#include "viewer/interact/paced_input.hpp"
#include "viewer/interact/scripted_input.hpp"
#include "viewer/interact/selection.hpp"
#include "viewer/ui/shell.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace tumble {

struct ApplicationOptions {
  SceneOpener open;
  std::vector<SceneItem> scenes;            ///< scenes offered in the list
  std::filesystem::path shaders;            ///< resource_path("shaders")
  std::filesystem::path capture_folder;     ///< for screenshots and sequences
  std::filesystem::path thumbnail_folder;   ///< thumbnails of scenes; empty: none
  std::filesystem::path thumbnail_program;  ///< the tumble program, which renders thumbnails;
                                            ///< empty: they are not made
  std::filesystem::path unsaved_folder;     ///< for unsaved work; empty: it is not kept
  int threads = 0;                          ///< of the simulation; 0: one per core
  std::string version;                      ///< of the program, written into frames.json
  /// If false, frame() opens scenes and steps the world itself, by dt, so that equal input gives
  /// equal bits.
  bool own_thread = true;
  bool hints = true;                       ///< show a line of help at the start
  Preferences preferences;                 ///< as read from the user's files
  std::filesystem::path preferences_file;  ///< where changes of them are saved; empty: nowhere
  std::vector<std::string> faults;         ///< faults in these files, reported once
};

/// The interactive program without its window: passes input to its parts, carries out actions and
/// requests, and draws. A real window and tests on EGL, OSMesa and the null device drive it in the
/// same way. All changes to the world go through World commands on the session.
class Application {
 public:
  using Picture = PictureLayout::Size;

  /// The device outlives the application. Fails when the renderer cannot be made.
  static Result<std::unique_ptr<Application>> create(Device& device, ApplicationOptions options,
                                                     OpenedScene scene);
  ~Application();

  /// Processes input and draws one picture: `input` (positions in UI units), `dt` seconds after
  /// the last.
  Status frame(std::span<const InputEvent> input, double dt, const Picture& picture);
  /// Shows the last picture in the device's window.
  void present() { canvas_.renderer().present(); }
  /// To be called when the contents of the graphics memory may be lost.
  void draw_anew() { canvas_.renderer().draw_anew(); }
  Status read_back(Image& image) { return canvas_.renderer().read_back(image); }

  bool quit_requested() const { return quit_; }
  /// Requests to quit; if there is unsaved work, a question is asked first, but only once.
  void ask_to_quit();
  /// Completes what is under way so that all files are whole, e.g. a recording gets its list.
  void finish();
  /// Whether a scene is being opened on another thread; destruction waits for it.
  bool opening() const { return opening_.busy(); }
  bool full_screen() const { return full_screen_; }
  PointerLook pointer_look() const { return pointer_.look(); }
  /// The user's scale of panels and text, as a factor on the monitor's scale.
  double zoom() const { return ui_.zoom; }
  const std::string& title() const { return scene_.title.empty() ? scene_.name : scene_.title; }

  /// Opens a scene in the background, as if chosen in the list. The old one is shown until the new
  /// one is ready; if it cannot be opened, the old one stays and the faults are listed.
  void open(const std::string& name_or_path) { open(OpenRequest{name_or_path, {}, {}}); }
  void open(OpenRequest wanted);
  void perform(Action action);

  // -- for scripts, tests and the status file -----------------------------------------------------
  std::optional<ScriptedInput::Point> locate(std::string_view place) const;
  Session& session() { return world_.session(); }
  UiHost& ui() { return host_; }
  UiState& ui_state() { return ui_; }
  CameraController& camera() { return camera_.controller(); }
  const SessionView& view() const { return world_.view(); }
  const RenderScene& picture() const { return canvas_.picture(); }
  const FrameReport& report() const { return canvas_.report(); }
  const ViewArea& area() const { return layout_.area; }
  const std::string& scene_name() const { return scene_.name; }
  BodyId selected() const { return selection_.main(); }
  const Selection& selection() const { return selection_; }
  /// The contact being inspected; null if there is none or nothing is known of it yet.
  const ContactView* contact() const { return instruments_.probe.view(); }
  bool dragging() const { return pointer_.drag().active(); }
  bool recording() const { return world_.recorder().active(); }
  int threads() const { return options_.threads; }
  const std::vector<std::filesystem::path>& captured() const { return screenshots_.saved(); }
  const Measures& measures() const { return instruments_.measures; }
  const Thumbnails& thumbnails() const { return thumbnails_; }
  const FolderView* browsed() const { return browsed_ ? &*browsed_ : nullptr; }
  const SceneMarks& marks() const { return marks_.marks(); }
  const Ruler& ruler() const { return instruments_.ruler; }
  /// Null: there is no comparison.
  const WorldComparison* comparison() const { return second_.comparison(); }
  WorldSettings settings() const { return settings_.value(); }
  void ask(const UiRequest& request) { apply(request); }
  /// Empty: the scene has no lesson.
  std::optional<LessonView> lesson() const { return lesson_view(); }

 private:
  Application(ApplicationOptions options, Canvas canvas);
  void show(OpenedScene scene, bool goes_on = false);
  void open_for(SceneOpening::Cause cause, OpenRequest wanted);
  std::vector<ChoiceHistory::Step> undo_steps_as_choices(const OpenRequest& start,
                                                         std::string text);
  void finish_opening(SceneOpening::Opened done);
  /// Selection and focus by name, to be found again in a scene that is opened anew.
  struct LookedAt {
    std::vector<BodyId> selected;
    std::vector<Quantity> curves;
  };
  LookedAt looked_at_in(const OpenedScene& scene) const;
  void keep_choices(SceneOpening::Cause& cause);
  void look_at_view();
  UiModel model() const;
  void route(std::span<const InputEvent> events, double dt);
  bool route_key(const KeyPressed& key);
  bool dialog_open() const;
  void press_in_dialog(const KeyPressed& key);
  void add_curve(Quantity quantity);
  WorldChoice own_choice() const;
  void compare(const WorldChoice& wanted);
  void begin_comparison(const WorldChoice& wanted);
  void show_second(ComparisonController::Opened opened);
  std::vector<InputEvent> in_time_for_search(std::span<const InputEvent> events);
  bool give_up_gesture();
  void close_something();
  void open_inspector();
  void end_building();
  void apply(const PointerEffects& effects);
  void apply(const UiRequest& request);
  std::string name_of(BodyId id) const;
  UndoStepEdits begin_edit(std::string what, bool by_gesture = false);
  Removal begin_removal(std::string what);
  void save_scene();
  void write_scene(const std::string& file);
  void look_at_files(double dt);
  void take_up(const UnsavedWork::Kept& kept, std::filesystem::path called = {});
  void offer_kept_work();
  void offer_unnamed_work();
  bool in_gesture() const;
  void take_back();
  void take_back_draft();
  void do_again();
  void delete_selected();
  void duplicate_selected();
  void copy_selected();
  void paste();
  void select_all();
  void select_box(const PointerBox& box);
  void show_handles(HandleKind kind);
  void arrange(const PointerEffects& effects);
  void arrange_to(double x, double y);
  void end_arranging();
  double placing_reach() const;
  void hold_arranged();
  void displace_selected(const Displacement& way);
  std::string selected_names() const;
  Handles::View handles_view() const;
  ArrangeGestures gestures() const;
  std::optional<Vec3> handle_grip(std::string_view name) const;
  void change_settings(const WorldSettings& wanted);
  void edit_body(const EditBody& edit);
  void rename_body(const std::string& name, const std::string& to);
  std::string described_text();
  void look_at_description();
  std::optional<DescriptionController::Changed> described_with(const EditDescription& edit);
  void edit_description(const EditDescription& edit);
  bool describe_live(const std::string& before, const std::string& after, const ScenePath& path,
                     const std::string& what);
  bool describe_body_live(const std::string& before, const std::string& after,
                          const ScenePath& path, const std::string& what);
  bool stands_at_start() const;
  void finish_description(const Status& opened);
  void edit_joint(const EditJoint& edit);
  void take_mesh_modes();
  void remove_joint(JointId id);
  void add_parts(PartKind kind, const Vec3& at, const Vec3& normal, double size);
  void edit_part(const EditPart& edit);
  void remove_part(const RemovePart& removal);
  void draw_emitters();
  void begin_building();
  void keep_hints();
  void build_at(double x, double y, const std::optional<Pick>& pressed);
  void change_parameter(const ChangeParameter& change);
  void choose(const std::vector<std::string>& overrides, std::string what, uint64_t tick);
  void choose(OpenRequest after, std::string what, uint64_t tick);
  OpenRequest request_of_now();
  bool go_back_on(std::optional<ChoiceHistory::Step> choice);
  void shoot(const Ray& ray);
  void end_drag();
  void look_into(const std::optional<ContactPick>& contact);
  void forget_what_is_gone();
  void warn_of_removal();
  void restart(bool as_scene);
  void flip_overlay(bool Overlays::*overlay, Action action);
  bool shows_anything(bool Overlays::*overlay);
  void neighbour_scene(int direction);
  void change_hierarchy_level(int by);
  void toggle_microscope();
  void go_to_microscope_step(int step);
  void draw_marks();
  Recording new_recording() const;
  ExtractOptions extract_options() const;
  void show_notices();
  void look_at_replay();
  void tell_of_replay();
  bool follows_replay() const;
  void save_replay(bool packed);
  void toggle_recording(bool video = false);
  double aspect() const { return layout_.area.aspect(); }
  bool stands_beside() const;
  void next_comparison_view();
  double trail() const { return ui_.trail.value_or(scene_.trail); }
  void name_pictures(RenderScene& a, RenderScene& b) const;
  void look_from(const ViewArea& area);
  Status draw_pictures(UiDrawList& panels, const ViewArea& area, int width, int height);
  Status draw_sequence(Recorder& recorder);
  Status draw();
  Status without_broken_shaders(Status drawn);
  void save_plain_screenshot();
  void save_screenshot();
  void write_measures();
  std::string marked_scene() const;
  void open_marks(double tick_seconds);
  void keep_marks(bool once_more = false);
  void look_at_marks();
  bool perform_in_time(Action action);
  bool apply_in_time(const UiRequest& request);
  void edit_marks(const std::function<void(TimeMarks&)>& change);
  void change_marks(const std::function<void(SceneMarks&)>& change);
  void follow_flight();
  void go_to_moment(uint64_t tick);
  void jump_to_event();
  void look_at_jump();
  void toggle_loop();
  void leave_loop();
  bool recording_forbids(const std::string& what);
  void add_camera_key();
  void follow_from_key(const FollowFromKey& wanted);
  std::optional<Vec3> place_of_body(const std::string& name) const;
  void toggle_flight();
  void fly();
  void change_flight(const std::function<void(std::vector<CameraKey>&)>& change);
  void save_plot();
  void rule_at(const std::optional<Pick>& hit);
  void keep_preferences();
  void browse(const std::string& folder);
  void begin_lesson();
  void turn_lesson_page(size_t step);
  void show_lesson_page(bool turned);
  void answer_lesson(const std::string& said);
  void take_lesson_choice();
  bool lesson_choice_is_taken(const std::vector<std::string>& choose) const;
  std::optional<LessonView> lesson_view() const;

  ApplicationOptions options_;
  Canvas canvas_;
  ShownWorld world_;
  OpenedScene scene_;  ///< without its world, which the session has
  SceneOpening opening_;
  SceneFileController scene_file_;
  ShownSettings settings_;
  WorldSettings settings_before_;  ///< settings before the newest change of them
  ReplayController replay_;
  ComparisonController second_;

  UndoManager undo_steps_;
  DescriptionController description_;
  Selection selection_;
  EditingTools tools_;
  std::unique_ptr<OpeningTrial> removal_trial_;  ///< null: nothing was deleted, or all is known
  Instruments instruments_;
  MarksController marks_;
  /// Overlays switched on by the lesson's page, and those switched on for building.
  LentOverlays lesson_overlays_, building_overlays_;

  PictureLayout layout_;
  SceneCamera camera_;
  bool own_flight_ = false;  ///< the camera follows the user's flight, not the scene's path
  Screenshots screenshots_;
  bool plot_wanted_ = false;              ///< the plot is to be saved as an image
  std::set<std::string> broken_shaders_;  ///< pipelines whose link failure was reported

  UiHost host_;
  UiState ui_;
  QuestionController question_;
  Pointer pointer_;
  MousePull mouse_pull_;
  PacedInput paced_input_;
  std::vector<InputEvent> early_text_;  ///< typed before the search field had the keyboard
  bool searched_ = false;               ///< a search for a quantity was active
  Thumbnails thumbnails_;
  /// An item of a list of the scene that gets another name.
  struct Renaming {
    std::string list, from, to;
  };
  std::optional<Renaming> renaming_;          ///< while the scene with that name is opened
  std::vector<std::string> described_along_;  ///< went with what was left out of the description
  bool described_camera_ = false;             ///< a camera was changed, which is to be seen
  bool describing_ = false;                   ///< what opens next is a changed description
  std::optional<FolderView> browsed_;         ///< none: the list of scenes is shown
  bool quit_ = false, full_screen_ = false;
};

}  // namespace tumble
