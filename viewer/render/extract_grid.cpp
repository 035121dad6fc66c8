#include "engine/collision/broad_phase.hpp"
#include "engine/collision/shape.hpp"
#include "viewer/render/extract.hpp"
#include "viewer/render/scene_draw.hpp"

namespace tumble {

void add_grid(const Frame& frame, const std::vector<Pose>& poses, RenderScene& out) {
  std::vector<BroadPhaseProxy> proxies;
  for (size_t slot = 0; slot < poses.size(); ++slot) {
    const BodyFrame& body = frame.body(slot);
    if (body.id.is_null()) continue;
    const bool moving = frame.info(slot).type != BodyType::fixed && !body.asleep;
    for (const BodyShape& part : frame.info(slot).shapes)
      proxies.push_back({part.shape->bounds(poses[slot] * part.pose), moving});
  }
  for (const BroadPhaseEntry& entry : all_broad_phases()) {
    if (entry.name != frame.broad_phase) continue;
    const auto phase = entry.make();
    std::vector<ProxyPair> pairs;
    phase->find_pairs(proxies, pairs);
    SceneDraw draw(out);
    phase->draw(proxies, draw);
  }
}

}  // namespace tumble
