#pragma once
#include "engine/core/error.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/scene/build/mesh_representations.hpp"
#include "engine/scene/description/part.hpp"
#include "engine/world/events/world_event.hpp"
#include "engine/world/frame.hpp"
#include "engine/world/microscope/microscope.hpp"
#include "engine/world/settings.hpp"
#include "viewer/interact/handles.hpp"
#include "viewer/interact/key_map.hpp"
#include "viewer/render/overlays.hpp"
#include "viewer/render/ui_draw_list.hpp"
#include "viewer/ui/assertion_view.hpp"
#include "viewer/ui/build_choice.hpp"
#include "viewer/ui/comparison.hpp"
#include "viewer/ui/contact_view.hpp"
#include "viewer/ui/description_view.hpp"
#include "viewer/ui/history.hpp"
#include "viewer/ui/lesson_view.hpp"
#include "viewer/ui/measures.hpp"
#include "viewer/ui/question.hpp"
#include "viewer/ui/ruler_view.hpp"
#include "viewer/ui/save_preview.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/time_marks.hpp"
#include "viewer/ui/ui_rect.hpp"

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tumble {

struct SceneDescription;

/// A scene that can be opened by name.
struct SceneItem {
  std::string name;
  std::string doc;         ///< one line
  std::string category;    ///< "": none
  std::string file;        ///< of which its thumbnail is made; "": none is
  std::string title = {};  ///< as lists show it; "": the name
};

/// A folder that is being looked through for files to open.
struct FolderView {
  struct Entry {
    std::string name;
    bool folder = false;
  };
  std::string path;
  std::vector<Entry> entries;  ///< folders first, then files that can be opened
  std::string fault;           ///< why there are none; "": there are
};

/// A number that the scene declares, to be changed by opening the scene with another one.
struct SceneParameter {
  std::string name, doc;
  double value = 0;
  std::optional<double> min, max;

  /// Counts are written as whole numbers, limits included, and stay so.
  bool whole() const;
};

/// A joint at the selected body.
struct SelectedJoint {
  JointId id;
  JointDef def;
  BodyId other;  ///< null: the world
};

/// All that a mesh can collide as, side by side.
struct MeasuredMesh {
  std::shared_ptr<const TriangleMesh> mesh;
  std::vector<RepresentationFacts> all;
};

/// A key of the flight of the camera.
struct FlightKeyView {
  double time = 0;     ///< [s]
  std::string follow;  ///< the body that it moves along with; "": none
};

/// What the panels show; filled anew for each picture by the application.
struct UiModel {
  std::shared_ptr<const Frame> frame;              ///< never null
  std::vector<SceneItem> const* scenes = nullptr;  ///< never null while drawing
  /// Pictures of scenes by name, as far as they are made; null: there are none.
  const std::map<std::string, UiTextureId>* thumbnails = nullptr;
  const FolderView* folder = nullptr;  ///< null: none is looked through
  std::string start_folder;            ///< where looking through begins
  std::string scene_name, scene_title, scene_doc;
  std::vector<SceneParameter> const* parameters = nullptr;  ///< of the scene; null: none
  std::string opening;         ///< the scene that is being opened, "" when none is
  double opening_seconds = 0;  ///< for how long [s]
  WorldSettings settings;
  int threads = 0;  ///< 0: one per core
  bool paused = false;
  double speed = 1;
  bool behind = false;               ///< the simulation does not keep up with real time
  double tick_seconds = 0;           ///< wall time of a step [s]
  double dropped_seconds = 0;        ///< real time given up [s]
  uint64_t first_tick = 0;           ///< how far stepping back reaches
  uint64_t last_tick = 0;            ///< the newest on this course of history
  std::vector<uint64_t> deed_ticks;  ///< at which a person changed something
  uint64_t next_tick = 1;            ///< the one that is, or would be, computed now
  double under_way_seconds = 0;      ///< since when it is; 0 while none is [s]
  uint64_t way_to = 0;               ///< the tick that was asked for, and is not reached; 0: none
  std::string asking;                ///< what the world is being asked; "" for nothing
  double asking_seconds = 0;         ///< for how long [s]
  std::optional<Error> fault;        ///< why the simulation stopped
  double picture_seconds = 0;        ///< from one picture to the next, smoothed [s]
  double drawing_seconds = 0;        ///< wall time of drawing one picture [s]
  std::string renderer;              ///< as the driver says
  uint32_t draw_calls = 0;
  uint64_t triangles = 0;
  const History* history = nullptr;
  const WorldComparison* comparison = nullptr;  ///< null: there is no world B
  const Measures* measures = nullptr;           ///< never null while drawing
  std::optional<double> past_share;  ///< of the past of curves, computed; none: nothing is
  const TimeMarks* marks = &no_time_marks;
  const TickClock* clock = &usual_tick_clock;
  const RulerView* ruler = &no_rulers;
  std::vector<FlightKeyView> flight;  ///< the keys of a flight, by time
  bool flying = false;                ///< the camera is on it
  /// Names of all that assertions of this scene can speak of; null: of none.
  std::shared_ptr<const std::vector<std::string>> quantity_names;
  std::vector<AssertionView> assertions;  ///< that the scene makes
  std::optional<LessonView> lesson;       ///< that it teaches
  /// Emitters, sensors, forces and particles of the scene; null: not known yet.
  std::shared_ptr<const SceneDescription> parts;
  /// By tick; null while nobody looks at them.
  std::shared_ptr<const std::vector<WorldEvent>> events;
  BodyId selected;                              ///< the main one,
  size_t selected_count = 0;                    ///< of so many
  std::shared_ptr<const BodyDef> selected_def;  ///< null: nothing is selected, or known yet
  /// At the selected body; null: nothing is selected, or known yet.
  std::shared_ptr<const std::vector<SelectedJoint>> selected_joints;
  std::shared_ptr<const MeasuredMesh> measured_mesh;   ///< the newest; null: none
  bool measuring_mesh = false, changing_mesh = false;  ///< under way
  bool reading_mesh = false;                           ///< that of the palette
  std::string palette_fault;  ///< why the palette's mesh cannot be placed; "": it can
  const DescriptionView* description = nullptr;  ///< null: there is no file to be described
  const ContactView* contact = nullptr;  ///< null: none is looked at, or nothing is known yet
  std::optional<UiRect> selection_box;   ///< being drawn by the pointer [UI units]
  bool has_snapshot = false;
  const Question* question = nullptr;  ///< to be answered before anything else; null: none
  const SavePreview* save = nullptr;   ///< null: not known yet
  bool recording = false;
  uint64_t recorded_frames = 0;
  const MicroscopeRecording* microscope = nullptr;  ///< null: nothing is looked at
  int microscope_step = 0;
  std::string microscope_algorithm;  ///< "" when nothing is under the microscope
  std::string microscope_refusal;    ///< why `microscope` is null
  bool microscope_waits = false;     ///< it is null until the world stands still
};

// -- what panels ask for -----------------------------------------------------------------------
struct OpenScene {
  std::string name;  ///< of the list, or a path
};
/// Looks through a folder for files to open; "": no longer.
struct BrowseFolder {
  std::string path;
};
/// The scene anew, with another value of a number that it declares.
struct ChangeParameter {
  std::string name;
  double value = 0;
};
struct ChangeSettings {
  WorldSettings settings;
};
struct ChangeThreads {
  int threads = 0;
};
struct ChangeSpeed {
  double speed = 1;
};
/// Longer ticks are shown, with a way out of them: what is faster nobody would cancel [s].
constexpr double slow_tick_seconds = 1;
/// Gives up the tick under way.
struct CancelTick {};
/// The question to the world that is under way.
struct CancelQuestion {};
/// A question that takes longer is shown, with a way out of it [s].
constexpr double slow_question_seconds = 0.3;
/// Pauses and shows another moment.
struct SeekTick {
  uint64_t tick = 0;
};
/// Writes the scene with what was changed.
struct WriteScene {
  std::string file;
};
/// Watches one more quantity, one less, or writes what was seen of all.
struct AddCurve {
  Quantity quantity;
};
struct RemoveCurve {
  size_t index = 0;
};
struct WriteMeasures {};
/// The past of curves is not computed.
struct LeavePast {};
/// The same of a quantity by the name that assertions know it by.
struct AddNamedCurve {
  std::string name;
};
/// Writes the picture of all curves.
struct WritePlot {};
/// Changes bookmarks and the span that is looped.
struct EditMarks {
  std::function<void(TimeMarks&)> change;
};
/// Goes to a moment, by computing it where it has not been seen yet.
struct GoToMoment {
  uint64_t tick = 0;
};
struct RemoveReading {
  size_t index = 0;
};
struct RemoveFlightKey {
  size_t index = 0;
};
/// A key moves along with a body from now on; "": with none. At the moment of that key only, for
/// that says where the body is then.
struct FollowFromKey {
  size_t index = 0;
  std::string body;
};
struct SelectBody {
  BodyId id;
};
struct SelectContact {
  std::optional<ContactPick> contact;  ///< none: look at none
};
struct FocusBody {
  BodyId id;
};
/// Moves, turns or scales the selected bodies, about the main one.
struct DisplaceSelected {
  Displacement way;  ///< its pivot and frame are those of the handles
};
/// Changes the definition of a body, as it is when the change is carried out.
struct EditBody {
  BodyId id;
  std::string what;  ///< the deed, as undo names it
  std::function<void(BodyDef&)> change;
};
/// Lets a mesh of a body collide in another way, as soon as that is made.
struct ChangeMeshMode {
  BodyId id;
  size_t group = 0;  ///< of shape_groups()
  MeshMode mode = MeshMode::triangle_mesh;
  std::shared_ptr<const MeshSource> source;
  std::string what;  ///< the deed, as undo names it
};
/// Measures all that a mesh can collide as.
struct MeasureMesh {
  std::shared_ptr<const TriangleMesh> mesh;
};
/// The same of a joint.
struct EditJoint {
  JointId id;
  std::string what;
  std::function<void(JointDef&)> change;
};
struct RemoveJoint {
  JointId id;
};
/// Puts another description in the place of that of a part of the scene.
struct EditPart {
  std::string name;
  PartDescription before, after;
  std::string what;  ///< the deed, as undo names it
};
struct RemovePart {
  std::string name;
  PartDescription part;
};
/// Throws away changes of the description that do not make a scene yet.
struct LeaveDraft {};
/// World B beside this one from now on, as it is chosen here; also where there is one already.
struct Compare {
  WorldChoice choice;
};
struct EndCompare {};
/// The answer of this number to the model's question.
struct AnswerQuestion {
  size_t choice = 0;
};
struct TurnLessonPage {
  size_t page = 0;
};
/// To the question of the page that is shown.
struct AnswerLesson {
  std::string said;
};
/// Opens the scene with the settings that the page of the lesson chooses.
struct TakeLessonChoice {};
using UiRequest = std::variant<
    Action, OpenScene, ChangeSettings, ChangeThreads, ChangeSpeed, CancelTick, CancelQuestion,
    SelectBody, SelectContact, FocusBody, EditBody, ChangeParameter, SeekTick, WriteScene, Compare,
    EndCompare, EditJoint, RemoveJoint, AnswerQuestion, DisplaceSelected, AddCurve, RemoveCurve,
    WriteMeasures, TurnLessonPage, BrowseFolder, AnswerLesson, TakeLessonChoice, ChangeMeshMode,
    MeasureMesh, EditPart, RemovePart, AddNamedCurve, WritePlot, EditMarks, GoToMoment,
    RemoveReading, RemoveFlightKey, FollowFromKey, LeavePast, EditDescription, LeaveDraft>;

enum class ToastKind : uint8_t { info, warning, error };
struct Toast {
  ToastKind kind = ToastKind::info;
  std::string title;
  std::vector<std::string> lines;
  double seconds_left = 4;  ///< errors stay until they are closed
};

/// Panels that can be shown and hidden.
enum class PanelId : uint8_t {
  statistics,
  energy,
  drawing,
  inspector,
  settings,
  help,
  scenes,
  microscope,
  contact,
  build,
  save,
  measure,
  compare,
  question,
  assertions,
  events,
  lesson,
  parts,
  bookmarks,
  ruler,
  description
};
constexpr size_t panel_count = 21;

/// A part of the scene that is looked at: "emitters", "rain".
struct ChosenPart {
  std::string list, name;
};

/// How much work a picture is worth; automatic: as good as the machine draws fluently.
enum class PictureQuality : uint8_t { automatic, draft, standard, high };

/// What a person chose to see under the microscope, instead of what the scene asks for.
struct MicroscopeChoice {
  std::string algorithm;    ///< "": the scene's
  std::optional<int> step;  ///< none: as the clock says
};

/// How the curves of the plot stand.
enum class PlotForm : uint8_t {
  apart,     ///< each in a frame of its own
  together,  ///< in one frame, each with its own axis
  phase      ///< two quantities against each other
};
struct PlotChoice {
  PlotForm form = PlotForm::apart;
  size_t across = 0, up = 1;  ///< of a phase plot: which of the curves
  std::string search;         ///< for one more curve
  /// What was found last, and by what in which names.
  std::vector<std::string> found;
  std::string found_by;
  std::shared_ptr<const std::vector<std::string>> found_in;
};

/// Numbers that stand for a drag of handles.
struct TypedDisplacement {
  Vec3 shift = Vec3::Zero();     ///< [m]
  Vec3 turn_deg = Vec3::Zero();  ///< about x, then y, then z
  double scale = 1;
};

/// A value that a field did not take.
struct RefusedValue {
  std::string field;  ///< the mark of its widget; "": none
  std::string words;  ///< why
  double until = 0;   ///< when it has been said for long enough, on the clock of Dear ImGui [s]
};

/// What is being typed, or pulled, into a field of the description; given when the field is left.
struct TypedValue {
  std::string field;  ///< the mark of its widget; "": none
  std::string text;
};

/// What belongs to the panels themselves and outlives a picture.
struct UiState {
  bool visible[panel_count] = {};
  bool hidden = false;  ///< Tab: no panels at all
  Overlays overlays;
  MicroscopeChoice microscope;
  EventFilter event_filter;                         ///< of the list, and of marks and jumps
  BuildChoice build;                                ///< what clicks build,
  bool building = false;                            ///< while they do
  bool choosing_mesh = false;                       ///< the files are for the palette
  ChosenPart part;                                  ///< whose values are shown
  ScenePath described;                              ///< what of the scene is shown
  TypedValue describing;                            ///< in one of its fields
  HandleSettings handles;                           ///< at the selected bodies
  ComparedAs compared_as = ComparedAs::ghost;       ///< how world B is shown
  PlotChoice plot;                                  ///< of the curves
  bool ruling = false;                              ///< clicks are points of a ruler,
  bool ruling_angle = false;                        ///< or of a protractor
  std::optional<uint64_t> span_began;               ///< while a span of time is being drawn
  RefusedValue refused;                             ///< the last one
  TypedDisplacement typed;                          ///< in place of a drag
  uint64_t scrubbed_to = 0;                         ///< the tick that the timeline asked for last
  std::map<std::string, double> pulled_parameters;  ///< of the scene, while they are being pulled
  PictureQuality quality = PictureQuality::automatic;
  Theme theme = Theme::dark;
  double zoom = 1;  ///< of panels and text, times the monitor's
  std::deque<Toast> toasts;
  std::string save_fault;    ///< why the last try to save failed; "": it did not
  std::string save_file;     ///< where the scene is to be written
  std::string lesson_typed;  ///< not yet given as an answer
  bool lesson_hint = false;  ///< of this page, was asked for
  std::string search;
  std::string category;                  ///< of the scenes that are listed; "": all
  std::vector<std::string> seen_scenes;  ///< listed in the last picture, on the screen
  int search_cursor = 0;
  bool search_opened = false;              ///< the field takes the keyboard in the next frame
  bool search_focus = false;               ///< the same, but what was typed stays
  float content_height[panel_count] = {};  ///< of the last frame, 0: unknown
  uint32_t raised[panel_count] = {};       ///< order of being shown; the greatest is the newest
  uint32_t raises = 0;

  /// Puts a panel before those that are shown already, where not all have room.
  void raise(PanelId id) { raised[size_t(id)] = ++raises; }
  /// Raises what is shown and was not before.
  void raise_new();
  bool& shows(PanelId id) { return visible[size_t(id)]; }
  bool shows(PanelId id) const { return visible[size_t(id)]; }
  void toast(ToastKind kind, std::string title, std::vector<std::string> lines = {});
};

}  // namespace tumble
