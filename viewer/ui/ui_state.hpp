#pragma once
#include "engine/core/error.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/scene/build/mesh_representations.hpp"
#include "engine/scene/description/part.hpp"
#include "engine/scene/saving/scene_edits.hpp"
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
#include "viewer/ui/pins.hpp"
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
  std::string doc;         ///< description in one line
  std::string category;    ///< "": none
  std::string file;        ///< from which its thumbnail is made; "": it has none
  std::string title = {};  ///< as lists show it; "": the name is shown
};

/// A folder shown in the file browser.
struct FolderView {
  struct Entry {
    std::string name;
    bool folder = false;
  };
  std::string path;
  std::vector<Entry> entries;  ///< folders first, then files that can be opened
  std::string fault;           ///< why it cannot be read; "": it can
};

/// A number that the scene declares; changing it opens the scene anew.
struct SceneParameter {
  std::string name, doc;
  double value = 0;
  std::optional<double> min, max;

  /// Whether it is a count: value and limits are whole numbers, and stay so.
  bool whole() const;
};

/// A joint at the selected body.
struct SelectedJoint {
  JointId id;
  JointDef def;
  BodyId other;  ///< the other body; null: the world
};

/// A body with a pinned value, and its joints.
struct PinnedBody {
  BodyId id;
  std::shared_ptr<const BodyDef> def;                          ///< null: not known yet
  std::shared_ptr<const std::vector<SelectedJoint>> joints{};  ///< null: not known yet
};

/// A comparison of all collision representations of a mesh.
struct MeasuredMesh {
  std::shared_ptr<const TriangleMesh> mesh;
  std::vector<RepresentationFacts> all;
};

/// A key of the camera's flight.
struct FlightKeyView {
  double time = 0;     ///< [s]
  std::string follow;  ///< the body whose motion it follows; "": none
};

/// Everything that the panels show; the application fills it anew for each picture.
struct UiModel {
  std::shared_ptr<const Frame> frame;              ///< never null
  std::vector<SceneItem> const* scenes = nullptr;  ///< never null while drawing
  /// Thumbnails of scenes by name, as far as they exist; null: none.
  const std::map<std::string, UiTextureId>* thumbnails = nullptr;
  const FolderView* folder = nullptr;  ///< the file browser; null: closed
  std::string start_folder;            ///< where the file browser begins
  std::string scene_name, scene_title, scene_doc;
  /// Of the scene; null: it declares none.
  std::vector<SceneParameter> const* parameters = nullptr;
  std::string opening;         ///< the scene that is being opened, "" when none is
  double opening_seconds = 0;  ///< for how long it has been [s]
  WorldSettings settings;
  int threads = 0;  ///< 0: one per core
  bool paused = false;
  double speed = 1;
  bool behind = false;                    ///< the simulation is slower than real time
  double tick_seconds = 0;                ///< wall time of a step [s]
  double dropped_seconds = 0;             ///< real time skipped because of that [s]
  uint64_t first_tick = 0;                ///< earliest tick that can be reached by stepping back
  uint64_t last_tick = 0;                 ///< latest tick known on the present course of the run
  std::vector<uint64_t> undo_step_ticks;  ///< ticks at which the user changed something
  uint64_t next_tick = 1;                 ///< the tick being computed, or to be computed next
  double under_way_seconds = 0;           ///< how long it has been computed; 0: it is not [s]
  uint64_t way_to = 0;                    ///< the tick being sought but not reached; 0: none
  bool searching = false;                 ///< the next event is being looked for
  double trail = 0;                       ///< length of the paths behind moving bodies [s]; 0: none
  size_t past_bytes = 0;                  ///< memory of the past that can be gone back to [bytes],
  size_t past_budget = 0;                 ///< at most [bytes]
  std::string asking;                     ///< the query that the world is answering; "": none
  double asking_seconds = 0;              ///< for how long it has been [s]
  std::optional<Error> fault;             ///< why the simulation stopped
  double picture_seconds = 0;             ///< from one picture to the next, smoothed [s]
  double drawing_seconds = 0;             ///< wall time of drawing one picture [s]
  std::string renderer;                   ///< name that the graphics driver reports
  uint32_t draw_calls = 0;
  uint64_t triangles = 0;
  const History* history = nullptr;
  const WorldComparison* comparison = nullptr;  ///< null: there is no world B
  const Measures* measures = nullptr;           ///< never null while drawing
  /// Progress of computing the past of curves, 0..1; none: not under way.
  std::optional<double> past_share;
  const TimeMarks* marks = &no_time_marks;
  const TickClock* clock = &usual_tick_clock;
  const RulerView* ruler = &no_rulers;
  std::vector<FlightKeyView> flight;  ///< keys of the camera's flight, by time
  bool flying = false;                ///< the camera is moving along them
  /// Names of all quantities that assertions of this scene can use; null: none.
  std::shared_ptr<const std::vector<std::string>> quantity_names;
  std::vector<AssertionView> assertions;  ///< assertions of the scene
  std::optional<LessonView> lesson;       ///< lesson of the scene
  /// Emitters, sensors, forces and particles of the scene; null: not known yet.
  std::shared_ptr<const SceneDescription> parts;
  /// Events by tick; null while no panel shows them.
  std::shared_ptr<const std::vector<WorldEvent>> events;
  BodyId selected;                              ///< the primary selection,
  size_t selected_count = 0;                    ///< of this many selected bodies
  std::shared_ptr<const BodyDef> selected_def;  ///< null: nothing is selected, or not known yet
  /// Joints of the selected body; null: nothing is selected, or not known yet.
  std::shared_ptr<const std::vector<SelectedJoint>> selected_joints;
  std::map<std::string, PinnedBody> pinned;            ///< by name, as far as they exist
  std::shared_ptr<const MeasuredMesh> measured_mesh;   ///< the newest comparison; null: none
  bool measuring_mesh = false, changing_mesh = false;  ///< under way
  bool reading_mesh = false;                           ///< that of the palette
  std::string palette_fault;  ///< why the palette's mesh cannot be placed; "": it can
  const DescriptionView* description = nullptr;  ///< null: there is no file to be described
  const ContactView* contact = nullptr;  ///< null: none is looked at, or nothing is known yet
  std::optional<UiRect> selection_box;   ///< being drawn by the pointer [UI units]
  bool has_snapshot = false;
  const Question* question = nullptr;  ///< modal question; null: none
  const SavePreview* save = nullptr;   ///< null: not known yet
  bool recording = false;
  uint64_t recorded_frames = 0;
  const MicroscopeRecording* microscope = nullptr;  ///< null: nothing is under the microscope
  int microscope_step = 0;
  std::string microscope_algorithm;  ///< "": nothing is under the microscope
  std::string microscope_refusal;    ///< why `microscope` is null
  bool microscope_waits = false;     ///< the recording is only made once the simulation is paused
};

// -- requests of panels ------------------------------------------------------------------------
struct OpenScene {
  std::string name;  ///< a name of the list, or a path
};
/// Opens a folder in the file browser; "" closes the browser.
struct BrowseFolder {
  std::string path;
};
/// Opens the scene anew with another value of a number that it declares.
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
/// Ticks that take longer are shown, with a button to cancel them [s].
constexpr double slow_tick_seconds = 1;
/// Cancels the tick under way.
struct CancelTick {};
/// Cancels the query under way.
struct CancelQuestion {};
/// Queries that take longer are shown, with a button to cancel them [s].
constexpr double slow_question_seconds = 0.3;
/// Pauses and goes to a tick.
struct SeekTick {
  uint64_t tick = 0;
};
/// Saves the scene with its changes.
struct WriteScene {
  std::string file;
};
/// Adds or removes a plotted quantity, or writes all as CSV.
struct AddCurve {
  Quantity quantity;
};
struct RemoveCurve {
  size_t index = 0;
};
struct WriteMeasures {};
/// Stops computing the past of curves.
struct LeavePast {};
/// Adds a plotted quantity by the name that assertions use.
struct AddNamedCurve {
  std::string name;
};
/// Writes the plot as an image.
struct WritePlot {};
/// Changes bookmarks and the span to be looped.
struct EditMarks {
  std::function<void(TimeMarks&)> change;
};
/// Seeks to a time; ticks not seen yet are computed.
struct GoToMoment {
  uint64_t tick = 0;
};
struct RemoveReading {
  size_t index = 0;
};
struct RemoveFlightKey {
  size_t index = 0;
};
/// Makes a key of the flight follow a body; "": none. Only at the key's own time, because the
/// body's pose must be known.
struct FollowFromKey {
  size_t index = 0;
  std::string body;
};
struct SelectBody {
  BodyId id;
};
struct SelectContact {
  std::optional<ContactPick> contact;  ///< none: ends the inspection
};
struct FocusBody {
  BodyId id;
};
/// Moves, turns or scales the selected bodies about the primary one.
struct DisplaceSelected {
  Displacement way;  ///< with the pivot and frame of the handles
};
/// Changes the definition of a body as it is when the request is executed.
struct EditBody {
  BodyId id;
  std::string what;  ///< description of the change for undo
  std::function<void(BodyDef&)> change;
  std::vector<WrittenKey> written = {};  ///< what the file says of it, where that was typed
  bool at_start = false;                 ///< of how it begins: only before the first tick
};
/// Changes the collision representation of a mesh, as soon as the new one has been computed.
struct ChangeMeshMode {
  BodyId id;
  size_t group = 0;  ///< index into shape_groups()
  MeshMode mode = MeshMode::triangle_mesh;
  std::shared_ptr<const MeshSource> source;
  std::string what;  ///< description of the change for undo
};
/// Compares all collision representations of a mesh.
struct MeasureMesh {
  std::shared_ptr<const TriangleMesh> mesh;
};
/// The same for a joint.
struct EditJoint {
  JointId id;
  std::string what;
  std::function<void(JointDef&)> change;
};
struct RemoveJoint {
  JointId id;
};
/// Replaces the description of a part of the scene.
struct EditPart {
  std::string name;
  PartDescription before, after;
  std::string what;  ///< description of the change for undo
};
struct RemovePart {
  std::string name;
  PartDescription part;
};
/// Throws away changes of the description that do not make a scene yet.
struct LeaveDraft {
  bool newest_only = false;
};
/// World B beside this one from now on, as it is chosen here; also where there is one already.
struct Compare {
  WorldChoice choice;
};
struct EndCompare {};
/// Gives the answer with this index to the model's question.
struct AnswerQuestion {
  size_t choice = 0;
};
struct TurnLessonPage {
  size_t page = 0;
};
/// Answers the question of the page shown.
struct AnswerLesson {
  std::string said;
};
/// Opens the scene with the settings of the lesson's page.
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

/// The part of the scene selected in the panel of parts: "emitters", "rain".
struct ChosenPart {
  std::string list, name;
};

/// Quality of the picture; automatic: the best that the machine draws fluently.
enum class PictureQuality : uint8_t { automatic, draft, standard, high };

/// The user's choices for the microscope, which take precedence over the scene's.
struct MicroscopeChoice {
  std::string algorithm;    ///< "": that of the scene
  std::optional<int> step;  ///< none: advances with time
};

/// Layout of the plotted curves.
enum class PlotForm : uint8_t {
  apart,     ///< each in a plot of its own
  together,  ///< in one plot with an axis per unit
  phase      ///< phase plot of two quantities
};
struct PlotChoice {
  PlotForm form = PlotForm::apart;
  size_t across = 0, up = 1;  ///< indices of the two curves of the phase plot
  std::string search;         ///< for a quantity to add
  /// Results of the last search, with the search text and list of names that they belong to.
  std::vector<std::string> found;
  std::string found_by;
  std::shared_ptr<const std::vector<std::string>> found_in;
};

/// A displacement typed instead of dragging handles.
struct TypedDisplacement {
  Vec3 shift = Vec3::Zero();     ///< [m]
  Vec3 turn_deg = Vec3::Zero();  ///< about x, then y, then z
  double scale = 1;
};

/// A value that a field rejected.
struct RefusedValue {
  std::string field;  ///< name of the field's widget; "": none
  std::string words;  ///< reason
  double until = 0;   ///< when the reason stops being shown, on Dear ImGui's clock [s]
};

/// What is being typed, or pulled, into a field that gives its text when it is left.
struct TypedValue {
  std::string field;  ///< the mark of its widget; "": none
  std::string text;
};

/// What belongs to the panels themselves and outlives a picture.
struct UiState {
  bool visible[panel_count] = {};
  bool hidden = false;  ///< all panels are hidden (Tab)
  Overlays overlays;
  MicroscopeChoice microscope;
  EventFilter event_filter;                         ///< of the list, and of marks and jumps
  BuildChoice build;                                ///< what clicks build,
  bool building = false;                            ///< while they do
  bool choosing_mesh = false;                       ///< the files are for the palette
  ChosenPart part;                                  ///< whose values are shown
  ScenePath described;                              ///< what of the scene is shown
  TypedValue typing;                                ///< in a field for text
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
  std::optional<double> trail;                      ///< length of trails [s]; none: the scene's
  Pins pins;                                        ///< values of the inspector, for Settings
  PictureQuality quality = PictureQuality::automatic;
  Theme theme = Theme::dark;
  double zoom = 1;  ///< of panels and text, times the monitor's scale
  std::deque<Toast> toasts;
  std::string save_fault;    ///< why the last attempt to save failed; "": it did not
  std::string save_file;     ///< where the scene is to be written
  std::string lesson_typed;  ///< answer being typed
  bool lesson_hint = false;  ///< the hint of this page was requested
  std::string search;
  std::string category;                  ///< category of scenes to list; "": all
  std::vector<std::string> seen_scenes;  ///< scenes whose entries were visible in the last picture
  int search_cursor = 0;
  /// The search field gets the keyboard in the next frame, its text selected.
  bool search_opened = false;
  bool search_focus = false;               ///< the same, but without selecting the text
  float content_height[panel_count] = {};  ///< in the last frame; 0: unknown
  bool idle[panel_count] = {};             ///< shows only what it is for: gives way to others
  bool beside = false;                     ///< two worlds' pictures share the room between panels
  /// Sequence number of the last raise; the greatest is the newest.
  uint32_t raised[panel_count] = {};
  uint32_t raises = 0;

  /// Gives a panel precedence over those already shown when not all fit.
  void raise(PanelId id) { raised[size_t(id)] = ++raises; }
  /// Raises panels that have become visible.
  void raise_new();
  bool& shows(PanelId id) { return visible[size_t(id)]; }
  bool shows(PanelId id) const { return visible[size_t(id)]; }
  void toast(ToastKind kind, std::string title, std::vector<std::string> lines = {});
};

}  // namespace tumble
