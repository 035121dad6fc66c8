// Replays: the one played with a scene, and that of the user's commands.
#include "viewer/app/scenes/scene_replay.hpp"
#include "viewer/app/window/application.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tumble {

/// Whether nothing but the replay has changed the world.
bool Application::follows_replay() const {
  return scene_.replay && scene_.replay->course() != ReplayPlayer::Course::left;
}

/// Reports the state of the replay each time that it changes.
void Application::tell_of_replay() {
  const auto course = scene_.replay->take_news();
  if (!course) return;
  if (*course == ReplayPlayer::Course::ended_same)
    ui_.toast(ToastKind::info, "The replay has ended as it was recorded");
  else if (*course == ReplayPlayer::Course::ended_otherwise)
    ui_.toast(ToastKind::warning, "The replay has ended otherwise than it was recorded");
  else if (*course == ReplayPlayer::Course::left)
    ui_.toast(ToastKind::info, "The replay is left: what happens from here on is yours",
              {"Take back what you changed, and it goes on"});
}

/// To be called once per picture.
void Application::look_at_replay() {
  if (scene_.replay) {
    tell_of_replay();
    // Commands of the replay may have changed the settings.
    if (replay_.has_done_more(*scene_.replay)) settings_.fetch(session(), follows_replay());
  }
  const auto saved = replay_.saver().take();
  if (!saved) return;
  if (!*saved)
    return ui_.toast(ToastKind::error, "The replay cannot be saved", {saved->error().text()});
  const ReplaySaver::Saved& done = **saved;
  std::vector<std::string> lines = {done.file.string()};
  if (!done.needs.empty())
    lines.push_back(fmt::format("It begins with --set {}: play it with that",
                                fmt::join(done.needs, " --set ")));
  ui_.toast(ToastKind::info,
            fmt::format("Replay of {:.2f} s saved, {} ticks", done.seconds, done.ticks),
            std::move(lines));
}

/// Saves the commands from the start to the moment shown.
void Application::save_replay(bool packed) {
  if (replay_.saver().busy()) return ui_.toast(ToastKind::info, "A replay is being saved already");
  if (packed && options_.own_thread)
    ui_.toast(ToastKind::info, "The replay is played once to be sure, and packed");
  replay_.saver().save(session(),
                       {options_.capture_folder, scene_.name, packed, options_.own_thread});
}

}  // namespace tumble
