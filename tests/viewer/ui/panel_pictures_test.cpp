// Pictures of each panel. References: the null device, which gets the same list of triangles; and
// what a person needs to read a panel: a dark page, light letters on it, and nothing that flickers.
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/context/gl_context.hpp"
#include "viewer/render/gl/gl_device.hpp"

#include <algorithm>
#include <map>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr const char* panel_scene = R"({
  "tumble_scene": 1, "title": "A ball on a floor",
  "parameters": { "height": { "value": 2, "min": 1, "max": 9, "doc": "of the ball [m]" } },
  "bodies": {
    "ground": { "type": "static", "shape": { "type": "half_space" }, "material": "wood" },
    "box": { "shape": { "type": "box", "size": [1, 1, 1] }, "position": [0, 0.5, 0] },
    "ball": { "shape": { "type": "sphere", "radius": 0.5 }, "position": [2, "$height", 0] }
  },
  "sensors": { "gate": { "type": "region", "size": [1, 1, 1], "position": [2, 1, 0], "takes": "bodies" } },
  "assertions": [{ "title": "the box stands", "holds": "bodies.box.speed < 1", "always": true }],
  "lesson": { "about": "falling", "steps": [{ "title": "One", "text": ["A ball falls."] }] },
  "cameras": { "main": { "position": [1, 2.5, 7], "target": [1, 1, 0] } }
})";

struct PanelShown {
  uint64_t list = 0;
  UiRect place;
  Image first, second;  ///< two pictures one after the other
};

/// A world that stands still, and each panel alone over it.
std::map<std::string, PanelShown> all_shown(Device& device) {
  Rig rig(device);
  rig.picture = {720, 480, 1};
  const std::string file = (rig.folder.path() / "panels.json").string();
  REQUIRE(write_file(file, std::string_view(panel_scene)).ok());
  rig.app->open(file);
  rig.play("wait 30\nkey Space\nwait 2");
  const auto box = rig.app->session().world().find_body("box");
  UiState& ui = rig.app->ui_state();
  std::map<std::string, PanelShown> out;
  for (const PanelEntry& panel : all_panels()) {
    CAPTURE(std::string(panel.name));
    std::ranges::fill(ui.visible, false);
    ui.toasts.clear();
    rig.app->ask(SelectBody{box});
    rig.play("wait 2");
    std::ranges::fill(ui.visible, false);
    if (panel.id == PanelId::contact) {
      ui.shows(PanelId::inspector) = true;
      rig.play("wait 3\nclick inspector.contact.0\nwait 3");
      ui.shows(PanelId::inspector) = false;
    } else if (panel.id == PanelId::question) {
      rig.app->ask(EditBody{box, "Change mass of box", [](BodyDef& d) { d.mass = 3; }});
      rig.play("wait 3");
      rig.app->ask_to_quit();
    } else if (panel.toggle && panel.id != PanelId::lesson) {
      rig.app->perform(*panel.toggle);
    } else {
      ui.shows(panel.id) = true;
    }
    ui.toasts.clear();
    rig.play("move 360,470\nwait 4");
    REQUIRE(ui.shows(panel.id));
    PanelShown& shown = out[std::string(panel.name)];
    const auto place = rig.app->ui().find("panel." + std::string(panel.name));
    REQUIRE(place.has_value());
    shown.place = *place;
    shown.list = rig.app->report().draws.hash;
    if (!rig.app->read_back(shown.first).ok()) shown.first = {};
    rig.frame();
    if (!rig.app->read_back(shown.second).ok()) shown.second = {};
    if (panel.id == PanelId::question) rig.play("key Esc\nkey Ctrl+Z\nwait 2");
    if (panel.id == PanelId::build || panel.id == PanelId::ruler || panel.id == PanelId::microscope)
      rig.app->perform(*panel.toggle);
    rig.play("wait 1");
  }
  check_no_faults(device);
  return out;
}

/// PixelShares of the pixels of a panel: of its page, and of letters on it.
struct PixelShares {
  double dark = 0, light = 0;
};
PixelShares shares_of(const PanelShown& shown) {
  PixelShares out;
  double all = 0;
  const UiRect& r = shown.place;
  for (int y = int(r.y) + 1; y < int(r.y + r.height) - 1; ++y)
    for (int x = int(r.x) + 1; x < int(r.x + r.width) - 1; ++x) {
      const uint8_t* p = shown.first.at(x, y);
      const int brightest = std::max({p[0], p[1], p[2]});
      all += 1;
      out.dark += brightest < 80 ? 1 : 0;
      out.light += brightest > 130 ? 1 : 0;
    }
  return {out.dark / all, out.light / all};
}

}  // namespace

TEST_CASE("each panel is the same list on every device, and in pixels a page that can be read") {
  const auto null_device = make_null_device();
  const auto expected = all_shown(*null_device);
  CHECK(expected.size() == panel_count);
  auto context = create_context("auto");
  if (!context.ok()) {
    MESSAGE("no context here: ", context.error().text());
    return;
  }
  auto device = make_gl_device(*context->context);
  REQUIRE(device.ok());
  for (const auto& [name, shown] : all_shown(**device)) {
    const auto& shown_name = name;
    CAPTURE(shown_name);
    const bool wall_time = name == "statistics";  // no two runs share it
    const bool own_path = name == "save";         // shows the folder of this test
    if (!wall_time && !own_path) CHECK(shown.list == expected.at(name).list);
    CHECK(shown.place.x >= 0);
    CHECK(shown.place.x + shown.place.width <= 720);
    CHECK(shown.place.y + shown.place.height <= 480);
    REQUIRE_FALSE(shown.first.empty());
    const PixelShares shares = shares_of(shown);
    CAPTURE(shares.dark);
    CAPTURE(shares.light);
    CHECK(shares.dark > 0.5);
    CHECK(shares.light > 0.004);
    CHECK(shares.light < 0.4);
    if (!wall_time) CHECK(image_hash(shown.first) == image_hash(shown.second));
  }
}
