#include "viewer/app/session/microscope_probe.hpp"

#include <atomic>

namespace tumble {

struct MicroscopeProbe::Answer {
  std::shared_ptr<const MicroscopeAnswer> said;
  std::atomic<bool> there = false;
};

void MicroscopeProbe::update(Session& session, const std::shared_ptr<const Frame>& frame,
                             const std::optional<MicroscopeSetup>& setup) {
  const MicroscopeEntry* entry = setup ? find_microscope(setup->algorithm) : nullptr;
  if (!entry || !entry->of_world()) return clear();
  if (pending_) {
    if (!pending_->there.load(std::memory_order_acquire)) return;
    said_ = pending_->said;
    pending_.reset();
  }
  const bool stands = session.paused();
  waits_ = !stands;
  if (!stands ||
      (asked_for_ == frame && asked_a_ == setup->a && asked_algorithm_ == setup->algorithm))
    return;
  asked_for_ = frame;
  asked_a_ = setup->a;
  said_.reset();
  asked_algorithm_ = setup->algorithm;
  pending_ = std::make_shared<Answer>();
  session.ask(asked_algorithm_, [answer = pending_, asked = *setup](const World& world) {
    answer->said = ask_world(world, asked);
    answer->there.store(true, std::memory_order_release);
  });
}

}  // namespace tumble
