#include "viewer/app/session/pinned_defs.hpp"

#include <algorithm>

namespace tumble {

void PinnedDefs::update(Session& session, const Frame& frame, const Pins& pins) {
  for (const Pin& pin : pins.all) bodies_.try_emplace(pin.body);
  std::erase_if(bodies_, [&](const auto& body) {
    return std::ranges::find(pins.all, body.first, &Pin::body) == pins.all.end();
  });
  if (bodies_.empty()) return;
  for (auto& [name, body] : bodies_) body.id = {};
  for (size_t slot = 0; slot < frame.body_slots(); ++slot) {
    if (frame.body(slot).id.is_null()) continue;
    const auto found = bodies_.find(frame.info(slot).name);
    if (found != bodies_.end()) found->second.id = frame.body(slot).id;
  }
  for (auto& [name, body] : bodies_) body.known.update(session, frame, body.id);
}

std::map<std::string, PinnedBody> PinnedDefs::all() const {
  std::map<std::string, PinnedBody> out;
  for (const auto& [name, body] : bodies_)
    if (!body.id.is_null()) out[name] = {body.id, body.known.def(), body.known.joints()};
  return out;
}

}  // namespace tumble
