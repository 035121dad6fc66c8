#include "viewer/app/session/shown_settings.hpp"

#include "engine/world/world.hpp"
#include "viewer/app/verify/differences.hpp"

#include <mutex>
#include <utility>

namespace tumble {

struct ShownSettings::Shared {
  std::mutex mutex;
  WorldSettings value;
  /// Settings as a replay has made them; none: it has not changed them.
  std::optional<WorldSettings> of_replay;
  /// Number of changes so far, to ignore the answer to a change that is not the newest.
  uint64_t changes = 0;
  std::optional<Error> refused;  ///< rejection of the newest change, until it is reported
};

void ShownSettings::open(const WorldSettings& of_scene) {
  shared_ = std::make_shared<Shared>();
  shared_->value = of_scene_ = of_scene;
}

WorldSettings ShownSettings::value() const {
  std::lock_guard lock(shared_->mutex);
  return shared_->value;
}

void ShownSettings::change(Session& session, const WorldSettings& wanted) {
  uint64_t number = 0;
  {
    std::lock_guard lock(shared_->mutex);
    shared_->value = wanted;
    number = ++shared_->changes;
  }
  session.post([shared = shared_, wanted, number](World& world) {
    const Status done = world.set_settings(wanted);
    std::lock_guard lock(shared->mutex);
    if (done || shared->changes != number) return;
    shared->value = world.settings();
    shared->refused = done.error();
  });
}

void ShownSettings::fetch(Session& session, bool of_replay) {
  session.post([shared = shared_, of_replay](World& world) {
    std::lock_guard lock(shared->mutex);
    shared->value = world.settings();
    if (of_replay) shared->of_replay = shared->value;
  });
}

std::vector<std::string> ShownSettings::restart(Session& session, bool as_scene,
                                                std::function<void(World&)> begin) {
  WorldSettings wanted = value();
  std::vector<std::string> changed = changed_settings(of_scene_, wanted);
  {
    std::lock_guard lock(shared_->mutex);
    const auto played = std::exchange(shared_->of_replay, {});
    const bool untouched = played && changed_settings(*played, wanted).empty();
    if (untouched) changed.clear();
    if (as_scene || untouched) wanted = of_scene_;
    shared_->value = wanted;
  }
  session.restart([wanted, begin = std::move(begin)](World& world) {
    if (begin) begin(world);
    if (!changed_settings(world.settings(), wanted).empty()) (void)world.set_settings(wanted);
  });
  return changed;
}

std::optional<Error> ShownSettings::take_refusal() {
  std::lock_guard lock(shared_->mutex);
  return std::exchange(shared_->refused, {});
}

}  // namespace tumble
