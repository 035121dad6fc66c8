#include "viewer/app/session/contact_probe.hpp"

#include "engine/core/stop.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <atomic>

namespace tumble {

struct ContactProbe::Answer {
  ContactView view;
  std::atomic<bool> there = false;
};

namespace {

std::optional<BodyBalance> balance_of(const ContactCertificates& all, uint32_t slot) {
  const auto it = std::find_if(all.bodies.begin(), all.bodies.end(),
                               [&](const BodyBalance& b) { return b.body == slot; });
  return it == all.bodies.end() ? std::nullopt : std::optional(*it);
}

/// The certificate between the two bodies that is nearest to where the contact was.
void look_up(const World& world, ContactView& view) {
  const auto all = world.contact_certificates();
  if (!all) {
    view.refusal = all.error().text();
    return;
  }
  const uint32_t a = view.pick.a.index, b = view.pick.b.index;
  if (!world.body(view.pick.a) || !world.body(view.pick.b)) return;
  const ContactCertificate* best = nullptr;
  const auto away = [&](const ContactCertificate& c) {
    return (c.x_world - view.pick.x_world).squaredNorm();
  };
  for (const ContactCertificate& c : all->contacts)
    if (std::minmax(c.key.body_a, c.key.body_b) == std::minmax(a, b) &&
        (!best || away(c) < away(*best)))
      best = &c;
  if (!best) return;
  view.certificate = *best;
  view.pick.x_world = best->x_world;
  if (best->key.body_a != a) std::swap(view.pick.a, view.pick.b);
  view.balance_a = balance_of(*all, best->key.body_a);
  view.balance_b = balance_of(*all, best->key.body_b);
}

}  // namespace

void ContactProbe::choose(const ContactPick& pick) {
  clear();
  chosen_ = true;
  pick_ = pick;
}

void ContactProbe::clear() {
  *this = ContactProbe{};
}

void ContactProbe::update(Session& session, const std::shared_ptr<const Frame>& frame) {
  if (!chosen_) return;
  if (pending_) {
    if (!pending_->there.load(std::memory_order_acquire)) return;
    known_ = pending_->view;
    pick_ = known_->pick;
    pending_.reset();
  }
  if (asked_for_ == frame) return;
  asked_for_ = frame;
  pending_ = std::make_shared<Answer>();
  pending_->view.pick = pick_;
  session.ask("what this contact claims", [answer = pending_](const World& world) {
    look_up(world, answer->view);
    if (stop_requested()) answer->view.refusal = "the question was stopped";
    answer->there.store(true, std::memory_order_release);
  });
}

}  // namespace tumble
