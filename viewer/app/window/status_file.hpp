#pragma once
#include "engine/core/result.hpp"
#include "viewer/app/window/application.hpp"

#include <cstdio>
#include <filesystem>
#include <future>
#include <memory>

namespace tumble {

/// What the window shows, as one line of JSON per picture, for tests and for scripts that drive the
/// window. Keys: picture, tick, time, paused, speed, scene, bodies (count), selected {name, x},
/// dragging, full_screen, recording, eye, pivot, state_hash, settings {tick_hz, gravity, stepper,
/// broad_phase, hierarchy, narrow_phase, contact_time, integrator, impulses, substeps}, threads,
/// overlays [name], panels [name], toasts [title], widgets {name: [x, y] of the centre in window
/// units}, points {body: {x, at}} and turn {body: |w|} of the first 64 dynamic bodies, captured
/// [file].
class StatusFile {
 public:
  /// Fails when the file cannot be made.
  static Result<StatusFile> create(const std::filesystem::path& path);
  /// Appends a line, which readers see at once. `window_units`: per UI unit.
  void add(Application& app, double window_units);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  /// Values that the world was last asked for.
  struct Known {
    uint64_t hash = 0;
    WorldSettings settings;
  };
  void ask_world(Session& session);

  std::unique_ptr<std::FILE, Close> file_;
  Known known_;
  std::future<Known> asked_;
  uint64_t pictures_ = 0;
};

}  // namespace tumble
