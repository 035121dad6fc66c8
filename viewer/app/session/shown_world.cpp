#include "viewer/app/session/shown_world.hpp"

#include "engine/world/world.hpp"

#include <algorithm>

namespace tumble {

void ShownWorld::show(std::unique_ptr<World> world, TickWatchers watchers,
                      std::shared_ptr<ReplayPlayer> replay) {
  const std::shared_ptr<const Frame> first = world->frame();
  snapshot_.reset();
  if (session_) {
    number_ = session_->replace(std::move(world), std::move(watchers), std::move(replay));
    if (!own_thread_) (void)session_->advance(0);
  } else {
    SessionOptions options;
    options.watchers = std::move(watchers);
    options.replay = std::move(replay);
    session_ = std::make_unique<Session>(std::move(world), std::move(options));
    if (own_thread_) session_->start();
  }
  view_ = {first, first, 1, 0, number_, nullptr};
  generation_ = 0;
}

void ShownWorld::advance(double dt) {
  if (recorder_.active()) return recorder_.advance(*session_);
  if (own_thread_) return;
  uint64_t ticks = 0;
  if (!session_->paused()) {
    // Rounded up slightly, so that 60 pictures of 1/60 s give 60 ticks of 1/60 s.
    behind_ticks_ += dt * session_->speed() / view_.to->rate.tick();
    ticks = uint64_t(behind_ticks_ + 1e-6);
    behind_ticks_ = std::max(0.0, behind_ticks_ - double(ticks));
  }
  (void)session_->advance(ticks);
}

ShownWorld::News ShownWorld::look() {
  const SessionView now = session_->view();
  if (now.world != number_) return News::none;
  const uint64_t before = view_.to->tick;
  view_ = now;
  recorder_.show(view_);
  const bool jumped = generation_ != 0 && view_.generation != generation_;
  generation_ = view_.generation;
  if (!jumped) return News::goes_on;
  return view_.to->tick > before ? News::ahead : News::back;
}

std::optional<std::string> ShownWorld::take_fault() {
  const std::optional<Error> fault = session_->fault();
  const std::string text = fault ? fault->text() : std::string();
  if (text == said_fault_) return {};
  said_fault_ = text;
  return text.empty() ? std::nullopt : std::optional(text);
}

}  // namespace tumble
