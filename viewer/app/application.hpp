#pragma once
#include "viewer/app/contact_probe.hpp"
#include "viewer/app/recorder.hpp"
#include "viewer/app/scene_loader.hpp"
#include "viewer/app/session.hpp"
#include "viewer/interact/picking.hpp"
#include "viewer/interact/pointer_tool.hpp"
#include "viewer/interact/scripted_input.hpp"
#include "viewer/render/extract.hpp"
#include "viewer/render/renderer.hpp"
#include "viewer/ui/shell.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tumble {

struct ApplicationOptions {
  SceneOpener open;
  std::vector<SceneItem> scenes;         ///< what the list offers
  std::filesystem::path shaders;         ///< resource_path("shaders")
  std::filesystem::path capture_folder;  ///< screenshots and sequences go there
  int threads = 0;                       ///< of the simulation; 0: one per core
  std::string version;                   ///< of the program, for frames.json
  /// false: frame() opens scenes and steps the world itself, by dt: same input, same bits.
  bool own_thread = true;
  bool hints = true;  ///< greet with a line of help
};

/// The program behind the window, without the window: takes input, runs the session, draws. Drives
/// a real window, and tests on EGL, OSMesa and the null device in the same way. Everything a person
/// does to the world goes through World commands on the session.
class Application {
 public:
  struct Picture {
    int width = 1280, height = 800;  ///< [px]
    double scale = 1;                ///< pixels per UI unit
  };

  /// The device outlives the application. Fails when the renderer cannot be made.
  static Result<std::unique_ptr<Application>> create(Device& device, ApplicationOptions options,
                                                     OpenedScene scene);
  ~Application();

  /// One picture: `events` (positions in UI units), `dt` seconds after the last.
  Status frame(std::span<const InputEvent> events, double dt, const Picture& picture);
  /// The last picture onto the device's window.
  void present() { renderer_->present(); }
  Status read_back(Image& image) { return renderer_->read_back(image); }

  bool quit_requested() const { return quit_; }
  /// Brings what is under way to an end that leaves whole files: a recording gets its list.
  void finish();
  /// A scene is being opened beside; destruction waits for it.
  bool opening() const { return loader_.busy(); }
  bool full_screen() const { return full_screen_; }
  PointerLook pointer_look() const { return pointer_look_; }
  const std::string& title() const { return scene_.title.empty() ? scene_.name : scene_.title; }

  /// Opens a scene as if it had been chosen, beside the drawing; the old one is shown until the new
  /// one is ready, and stays with a list of the faults when it cannot be opened.
  void open(const std::string& name_or_path);
  void perform(Action action);

  // -- for scripts, tests and the status file -----------------------------------------------------
  std::optional<ScriptedInput::Point> locate(std::string_view place) const;
  Session& session() { return *session_; }
  UiHost& ui() { return host_; }
  UiState& ui_state() { return ui_; }
  CameraController& camera() { return camera_; }
  const SessionView& view() const { return view_; }
  const RenderScene& picture() const { return render_scene_; }
  const FrameReport& report() const { return report_; }
  const std::string& scene_name() const { return scene_.name; }
  BodyId selected() const { return selected_; }
  /// The contact that is looked at; null when there is none, or nothing is known of it yet.
  const ContactView* contact() const { return probe_.view(); }
  bool dragging() const { return pointer_.drag().active(); }
  bool recording() const { return recorder_.active(); }
  int threads() const { return options_.threads; }
  const std::vector<std::filesystem::path>& captured() const { return captured_; }

 private:
  struct SharedSettings;
  struct HeldForce;

  Application(ApplicationOptions options);
  Status start(Device& device, OpenedScene scene);
  void show(OpenedScene scene);
  void finish_opening(const std::string& asked, Result<OpenedScene> opened);
  void advance(double dt);
  void look_at_view();
  void carry_camera();
  UiModel model();
  bool pointer_is_taken(std::span<const InputEvent> events, double dt) const;
  void route(std::span<const InputEvent> events, double dt, const Picture& picture);
  bool route_key(const KeyPressed& key);
  std::vector<InputEvent> in_time_for_search(std::span<const InputEvent> events);
  void close_something();
  void apply(const PointerEffects& effects);
  void apply(const UiRequest& request);
  void shoot(const Ray& ray);
  void end_drag();
  void look_into(const std::optional<ContactPick>& contact);
  void forget_what_is_gone();
  void fetch_settings();
  void restart(bool as_scene);
  void go_to_scene_camera();
  void frame_all();
  void flip_overlay(bool Overlays::*overlay, Action action);
  bool shows_anything(bool Overlays::*overlay);
  void neighbour_scene(int direction);
  void change_hierarchy_level(int by);
  void toggle_microscope();
  void go_to_microscope_step(int step);
  void draw_marks();
  Quality picture_quality();
  Recording new_recording() const;
  ExtractOptions extract_options() const;
  Status draw(const Picture& picture);
  Status take_screenshots(const Picture& picture);
  Status save_picture();

  ApplicationOptions options_;
  std::unique_ptr<Renderer> renderer_;
  std::string renderer_name_;
  std::unique_ptr<Session> session_;
  OpenedScene scene_;  ///< without its world
  SceneLoader loader_;
  UiHost host_;
  UiState ui_;
  History history_;
  HeldInput held_;
  std::vector<InputEvent> early_text_;
  PointerTool pointer_;
  CameraController camera_;
  ShapeMeshes meshes_;
  RenderScene render_scene_;
  UiDrawList ui_list_;
  UiRect free_area_;
  SessionView view_;
  Picker picker_;
  uint64_t generation_ = 0;
  uint64_t world_ = 0;              ///< whose views are shown
  Vec3 carried_to_ = Vec3::Zero();  ///< where the followed camera looked last [m]
  BodyId selected_;
  ContactProbe probe_;
  bool picked_for_microscope_ = false;  ///< by a person, not by the scene
  std::shared_ptr<SharedSettings> settings_;
  WorldSettings scene_settings_;  ///< as the scene was opened
  std::shared_ptr<HeldForce> held_force_;
  std::shared_ptr<Session::Kept> snapshot_;  ///< of F5; null: none yet
  Recorder recorder_;
  std::vector<std::filesystem::path> captured_;
  std::string shown_fault_;
  double behind_ticks_ = 0;  ///< without an own thread: part of a tick that is due
  double aspect_ = 1.6;
  int width_ = 0, height_ = 0;  ///< of the picture [px]
  double picture_seconds_ = 0, drawing_seconds_ = 0;
  FrameReport report_;
  PointerLook pointer_look_ = PointerLook::arrow;
  uint64_t frames_ = 0;
  bool software_ = false;  ///< the device draws on the processor
  int slow_pictures_ = 0;  ///< in a row
  bool quit_ = false, full_screen_ = false;
  bool want_screenshot_ = false, want_plain_screenshot_ = false;
};

}  // namespace tumble
