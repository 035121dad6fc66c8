#include "viewer/app/shown_settings.hpp"

#include "engine/world/world.hpp"
#include "viewer/app/changed_settings.hpp"

#include <mutex>
#include <utility>

namespace tumble {

struct ShownSettings::Shared {
  std::mutex mutex;
  WorldSettings value;
  uint64_t changes = 0;          ///< so far: of two under way the answer to the older is no news
  std::optional<Error> refused;  ///< the newest change, until it is said
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

void ShownSettings::fetch(Session& session) {
  session.post([shared = shared_](World& world) {
    std::lock_guard lock(shared->mutex);
    shared->value = world.settings();
  });
}

std::vector<std::string> ShownSettings::restart(Session& session, bool as_scene) {
  WorldSettings wanted = value();
  const std::vector<std::string> changed = changed_settings(of_scene_, wanted);
  if (as_scene) wanted = of_scene_;
  {
    std::lock_guard lock(shared_->mutex);
    shared_->value = wanted;
  }
  session.restart();
  session.post([wanted](World& world) {
    if (!changed_settings(world.settings(), wanted).empty()) (void)world.set_settings(wanted);
  });
  return changed;
}

std::optional<Error> ShownSettings::take_refusal() {
  std::lock_guard lock(shared_->mutex);
  return std::exchange(shared_->refused, {});
}

}  // namespace tumble
