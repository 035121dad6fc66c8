#include "viewer/ui/bar_plan.hpp"

#include <algorithm>

namespace tumble {
namespace {

constexpr float edge_gap = 10, part_gap = 14;
constexpr float least_scene = 64, usual_scene = 90, widest_scene = 250;
constexpr float pause = 32, steps = 3 * 32, speed = 122;
constexpr float clock = 150;  ///< width for time and tick

}  // namespace

BarPlan plan_bar(float width, const BarWidths& widths) {
  BarPlan plan;
  plan.scene_x = edge_gap;
  const auto right_with = [&](bool switches) {
    return width - edge_gap - (switches ? widths.switches : widths.menu);
  };
  const auto room = [&](float scene) {
    return plan.right_x - part_gap - edge_gap - scene - part_gap;
  };
  plan.right_x = right_with(true);
  if (room(usual_scene) < pause + steps) {
    plan.switches = false;
    plan.right_x = right_with(false);
  }
  plan.steps = room(least_scene) >= pause + steps;
  const float least_transport = pause + (plan.steps ? steps : 0);
  const float share = std::clamp(0.27f * plan.right_x, usual_scene, widest_scene);
  plan.scene_width = std::min(
      {widths.scene, share, plan.right_x - part_gap - least_transport - part_gap - edge_gap});
  plan.scene_width = std::max(plan.scene_width, 30.0f);
  plan.speed = plan.steps && room(plan.scene_width) >= pause + steps + speed;
  const float transport = least_transport + (plan.speed ? speed : 0);
  // Centred if there is room, otherwise after the scene's name.
  const float after = edge_gap + plan.scene_width + part_gap;
  plan.transport_x = std::max(after, std::min(0.5f * (width - transport) - 60,
                                              plan.right_x - part_gap - transport - clock));
  plan.transport_end = plan.transport_x + transport;
  return plan;
}

}  // namespace tumble
