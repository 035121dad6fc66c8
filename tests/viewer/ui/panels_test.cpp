// References: geometry of rectangles, brute force over all combinations of panels, hand-made lists.
#include "viewer/ui/fuzzy.hpp"
#include "viewer/ui/history.hpp"
#include "viewer/ui/layout.hpp"
#include "viewer/ui/shell.hpp"
#include "viewer/ui/widgets.hpp"

#include <numeric>

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("no two docked panels overlap and all stay on the picture, whatever is shown") {
  for (const auto& [width, height] : {std::pair{1280.0, 800.0}, {800.0, 500.0}, {2560.0, 1440.0}})
    for (unsigned bits = 0; bits < (1u << panel_count); ++bits) {
      UiState state;
      for (size_t i = 0; i < panel_count; ++i) {
        state.visible[i] = (bits >> i) & 1;
        state.content_height[i] = float(90 + 170 * i);
      }
      const UiLayout layout = layout_ui(width, height, state);
      std::vector<UiRect> docked{layout.top_bar, layout.free_area};
      for (const auto& placed : layout.panels) {
        const UiRect& r = placed.rect;
        CHECK(r.x >= 0);
        CHECK(r.y >= 0);
        CHECK(r.x + r.width <= float(width) + 0.01f);
        CHECK(r.y + r.height <= float(height) + 0.01f);
        if (placed.panel->dock != Dock::centre) docked.push_back(r);
      }
      for (size_t i = 0; i < docked.size(); ++i)
        for (size_t j = i + 1; j < docked.size(); ++j) CHECK_FALSE(docked[i].overlaps(docked[j]));
      // At the usual size most of the picture is the scene's.
      if (width >= 1280) CHECK(layout.free_area.width > 0.5f * float(width));
    }
}

TEST_CASE("a column is shared so that small wishes are met first") {
  const auto sum = [](const std::vector<float>& v) {
    return std::accumulate(v.begin(), v.end(), 0.0f);
  };
  CHECK(share_height({100, 200}, 400) == std::vector<float>{100, 200});
  CHECK(share_height({100, 500, 500}, 500) == std::vector<float>{100, 200, 200});
  CHECK(sum(share_height({300, 310, 900}, 600)) == doctest::Approx(600));
  CHECK(share_height({}, 100).empty());
}

TEST_CASE("fuzzy search finds parts and prefers beginnings and runs") {
  CHECK(fuzzy_score("", "anything"));
  CHECK(fuzzy_score("bw", "brick_wall"));
  CHECK(fuzzy_score("brick wall", "brick_wall"));
  CHECK_FALSE(fuzzy_score("wb", "brick_wall"));
  CHECK_FALSE(fuzzy_score("towers", "tower"));
  CHECK(*fuzzy_score("to", "tower") > *fuzzy_score("to", "demolition"));
  CHECK(*fuzzy_score("pile", "mesh_pile") > *fuzzy_score("pile", "pallet_in_a_lorry_e"));
}

TEST_CASE("the history follows ticks, forgets the future after going back, and stays bounded") {
  History history;
  Frame frame;
  for (uint64_t tick = 0; tick < 2 * History::capacity; ++tick) {
    frame.tick = tick;
    history.add(frame);
    history.add(frame);  // the same picture twice
  }
  CHECK(history.samples().size() == History::capacity);
  CHECK(history.samples().back().tick == 2 * History::capacity - 1);
  frame.tick = 2 * History::capacity - 10;
  history.add(frame);
  CHECK(history.samples().back().tick == frame.tick);
  for (size_t i = 1; i < history.samples().size(); ++i)
    CHECK(history.samples()[i - 1].tick < history.samples()[i].tick);
}

TEST_CASE("quantities are printed with four figures and a prefix") {
  CHECK(quantity_text(1234.5, "J") == "1.234 kJ");
  CHECK(quantity_text(0, "J") == "0 J");
  CHECK(quantity_text(-0.0123, "N") == "-12.30 mN");
  CHECK(quantity_text(999.99, "J") == "1000.0 J");
  CHECK(duration_text(0.0123) == "12.30 ms");
  CHECK(vector_text(Vec3(-0.001, 1, 2.345)) == "0.00  1.00  2.35");
}

TEST_CASE("a tap shorter than a frame still reaches the panels") {
  UiHost host;
  UiModel model;
  model.frame = std::make_shared<Frame>();
  const std::vector<SceneItem> scenes;
  const History history;
  model.scenes = &scenes;
  model.history = &history;
  UiState state;
  UiDrawList out;
  std::vector<UiRequest> requests;
  const auto picture = [&](std::vector<InputEvent> events) {
    host.begin(1280, 800, 1.0 / 60, events, false);
    PanelContext context{host, model, state, requests, 1.0 / 60};
    draw_ui(context, 1280, 800);
    host.end(out);
  };
  picture({});
  const auto button = host.find("transport.pause");
  REQUIRE(button);
  picture({PointerMoved{double(button->x) + 10, double(button->y) + 10}});
  picture({PointerPressed{PointerButton::left, true}, PointerPressed{PointerButton::left, false}});
  picture({});
  picture({});
  REQUIRE(requests.size() == 1);
  CHECK(std::get<Action>(requests[0]) == Action::toggle_pause);
}
