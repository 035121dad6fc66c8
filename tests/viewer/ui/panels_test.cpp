// References: geometry of rectangles, brute force over all combinations of panels, hand-made lists.
#include "viewer/ui/bar_plan.hpp"
#include "viewer/ui/difference_text.hpp"
#include "viewer/ui/fuzzy.hpp"
#include "viewer/ui/history.hpp"
#include "viewer/ui/layout.hpp"
#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/shell.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <doctest/doctest.h>
#include <imgui.h>

using namespace tumble;

namespace {
constexpr size_t docked_count = 17;
}

TEST_CASE("no two docked panels overlap and all stay on the picture, whatever is shown") {
  for (const auto& [width, height] : {std::pair{1280.0, 800.0},
                                      {800.0, 500.0},
                                      {2560.0, 1440.0},
                                      {640.0, 400.0},
                                      {480.0, 320.0},
                                      {360.0, 280.0}})
    for (unsigned bits = 0; bits < (1u << docked_count); ++bits) {
      UiState state;
      // Centred ones lie over the rest, whatever that is: all of them or none.
      size_t bit = 0;
      for (size_t i = 0; i < panel_count; ++i) {
        const bool centred = all_panels()[i].dock == Dock::centre;
        state.visible[i] = centred ? bits & 1 : (bits >> bit++) & 1;
        state.content_height[i] = float(90 + 170 * i);
      }
      REQUIRE(bit == docked_count);
      state.raise_new();
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

TEST_CASE("in a low window the panel shown last is open, and a click on another opens that") {
  UiState state;
  for (const PanelId id : {PanelId::drawing, PanelId::inspector, PanelId::settings}) {
    state.shows(id) = true;
    state.content_height[size_t(id)] = 300;
    state.raise_new();
  }
  const auto open = [&](double height) {
    std::vector<PanelId> out;
    for (const auto& placed : layout_ui(800, height, state).panels)
      if (!placed.folded) out.push_back(placed.panel->id);
    return out;
  };
  using Ids = std::vector<PanelId>;
  CHECK(open(800) == Ids{PanelId::drawing, PanelId::inspector, PanelId::settings});
  CHECK(open(420) == Ids{PanelId::inspector, PanelId::settings});
  CHECK(open(300) == Ids{PanelId::settings});
  state.raise(PanelId::drawing);
  CHECK(open(300) == Ids{PanelId::drawing});
  CHECK(layout_ui(800, 300, state).panels.size() == 3);
  for (const auto& placed : layout_ui(800, 300, state).panels)
    if (!placed.folded) CHECK(placed.rect.height >= 120);
  CHECK(open(130) == Ids{PanelId::drawing});
  CHECK(layout_ui(800, 130, state).panels.size() == 1);
}

TEST_CASE("a lesson is read in one piece above the panels beside it while they can be used") {
  UiState state;
  for (const auto& [id, height] : {std::pair(PanelId::lesson, 420.0f),
                                   {PanelId::energy, 600.0f},
                                   {PanelId::measure, 500.0f}}) {
    state.shows(id) = true;
    state.content_height[size_t(id)] = height;
  }
  state.raise_new();
  // From the top: the lesson, energy and the plot share a column 8 units apart.
  for (double height = 800; height <= 1700; height += 50) {
    CAPTURE(height);
    const auto& panels = layout_ui(1280, height, state).panels;
    REQUIRE(panels.size() == 3);
    REQUIRE(panels[0].panel->id == PanelId::lesson);
    for (size_t i = 1; i < 3; ++i) {
      CHECK_FALSE(panels[i].folded);
      CHECK(panels[i].rect.y ==
            doctest::Approx(panels[i - 1].rect.y + panels[i - 1].rect.height + 8));
    }
    const float lesson = panels[0].rect.height;
    const float least = std::min(panels[1].rect.height, panels[2].rect.height);
    CHECK(lesson >= doctest::Approx(400));
    CHECK(least >= doctest::Approx(120));
    if (lesson > 401) CHECK(least >= doctest::Approx(240));
    if (height >= 1000) CHECK(lesson == doctest::Approx(420));
  }
}

TEST_CASE("a lesson can be read in a small window, whatever else is shown") {
  UiState state;
  const auto show = [&](PanelId id, float height) {
    state.shows(id) = true;
    state.content_height[size_t(id)] = height;
    state.raise_new();
  };
  const auto height_of = [&](PanelId id, double width, double height) {
    for (const auto& placed : layout_ui(width, height, state).panels)
      if (placed.panel->id == id && !placed.folded) return placed.rect.height;
    return 0.0f;
  };
  show(PanelId::inspector, 90);
  state.idle[size_t(PanelId::inspector)] = true;
  show(PanelId::measure, 700);
  show(PanelId::lesson, 390);
  CHECK(height_of(PanelId::lesson, 800, 600) == doctest::Approx(390));
  CHECK(height_of(PanelId::measure, 800, 600) >= 120);
  // Panels of 130 % and 150 %.
  CHECK(height_of(PanelId::lesson, 615, 461) >= 220);
  CHECK(height_of(PanelId::lesson, 533, 400) >= 220);
  CHECK(height_of(PanelId::inspector, 533, 400) == 0);
  show(PanelId::build, 600);
  CHECK(height_of(PanelId::lesson, 800, 600) >= 330);
  CHECK(height_of(PanelId::build, 800, 600) >= 120);
  // A click on the plot's heading opens it.
  state.raise(PanelId::measure);
  CHECK(height_of(PanelId::measure, 533, 400) >= 120);
  // With a body selected its panel is one among the others.
  state.idle[size_t(PanelId::inspector)] = false;
  state.raise(PanelId::inspector);
  CHECK(height_of(PanelId::inspector, 615, 461) == doctest::Approx(90));
}

TEST_CASE("a panel with nothing to show takes no column from two pictures") {
  UiState state;
  state.shows(PanelId::inspector) = true;
  state.raise_new();
  state.idle[size_t(PanelId::inspector)] = true;
  const float alone = layout_ui(1280, 800, state).free_area.width;
  CHECK(alone < 1000);
  state.beside = true;
  CHECK(layout_ui(1280, 800, state).free_area.width == doctest::Approx(1260));
  CHECK(layout_ui(1280, 800, state).panels.empty());
  state.idle[size_t(PanelId::inspector)] = false;
  CHECK(layout_ui(1280, 800, state).free_area.width == doctest::Approx(alone));
}

TEST_CASE("the bar's pieces follow each other without overlap at every width") {
  for (const float title : {60.0f, 300.0f, 1000.0f}) {
    const BarWidths widths{title, 330, 62};
    for (float width = 360; width < 2000; width += 7) {
      CAPTURE(width);
      const BarPlan plan = plan_bar(width, widths);
      CHECK(plan.scene_x + plan.scene_width + 8 <= plan.transport_x);
      CHECK(plan.transport_end + 8 <= plan.right_x);
      CHECK(plan.right_x + (plan.switches ? widths.switches : widths.menu) <= width);
      CHECK(plan.scene_width >= std::min(title, 64.0f));
      CHECK(plan.transport_end - plan.transport_x >= (plan.steps ? 127.9f : 31.9f));
    }
  }
  CHECK(plan_bar(1280, {200, 330, 62}).speed);
  CHECK(plan_bar(800, {200, 330, 62}).switches);
  CHECK_FALSE(plan_bar(480, {200, 330, 62}).switches);
  CHECK(plan_bar(480, {200, 330, 62}).steps);
}

TEST_CASE("a column is shared so that small heights are met first") {
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

TEST_CASE("a search finds its letters in the best of all ways, not in the first") {
  // The first b and o are those of "bodies".
  CHECK(*fuzzy_score("bob", "bodies.bob.position.x") >
        *fuzzy_score("bob", "bodies.beam.position.x"));
  CHECK_FALSE(fuzzy_score("bob", "bo"));
  CHECK_FALSE(fuzzy_score("b", ""));
  CHECK(fuzzy_score(".", "anything") == 0);
  // Against every way of choosing letters, one by one.
  const std::string text = "ab_aab.ba";
  for (const std::string search : {"a", "ab", "aab", "aba", "bb", "abab"}) {
    bool possible = false;
    for (unsigned chosen = 0; chosen < 1u << text.size(); ++chosen) {
      std::string word;
      for (size_t i = 0; i < text.size(); ++i)
        if (chosen >> i & 1) word += text[i];
      possible |= word == search;
    }
    CHECK(fuzzy_score(search, text).has_value() == possible);
  }
}

TEST_CASE("settings are called by words, and units have their powers") {
  CHECK(label_of("contact_damping_ratio") == "contact damping ratio");
  CHECK(label_of("tick_hz") == "tick rate");
  CHECK(words_of("conservative_advancement") == "conservative advancement");
  CHECK(words_of("gjk") == "GJK");
  CHECK(words_of("v_clip") == "V-Clip");
  CHECK(words_of("aabb_tree") == "AABB tree");
  CHECK(words_of("implicit_euler") == "implicit Euler");
  CHECK(unit_words("m/s2") == "m/s²");
  CHECK(unit_words("kg/m3") == "kg/m³");
  CHECK(unit_words("kg m2") == "kg m²");
  CHECK(unit_words("1/s") == "1/s");
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
  CHECK(round_text(5000, "J") == "5 kJ");
  CHECK(round_text(-0.0025, "m") == "-2.5 mm");
  CHECK(round_text(0, "J") == "0");
  CHECK(duration_text(0.0123) == "12.30 ms");
  CHECK(vector_text(Vec3(-0.001, 1, 2.345)) == "0.00  1.00  2.35");
}

TEST_CASE("a text too long for its place ends in an ellipsis and fits") {
  UiHost host;
  UiDrawList out;
  host.begin(640, 400, 1.0 / 60, {}, false);
  const auto width_of = [](const std::string& s) { return ImGui::CalcTextSize(s.c_str()).x; };
  const std::string title = "Größte Säule – eine lange Überschrift";
  CHECK(shortened(title, width_of(title)) == title);
  for (float width = 30; width < width_of(title); width += 3) {
    const std::string text = shortened(title, width);
    CHECK(width_of(text) <= width);
    CHECK(text.ends_with("…"));
    CHECK(title.starts_with(text.substr(0, text.size() - 3)));
    // No character is cut in two.
    CHECK((title[text.size() - 3] & 0xC0) != 0x80);
  }
  CHECK(shortened("abc", 0) == "…");
  host.end(out);
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

TEST_CASE("what a file calls by words with strokes and points is read as words") {
  CHECK(label_of("contact_damping_ratio") == "contact damping ratio");
  CHECK(label_of("size.0") == "size 0");
  CHECK(label_of("euler_deg") == "turned about x, y, z");
}

TEST_CASE("what differs between two worlds is said in words with units") {
  CHECK(difference_text({"settings.gravity", "[0,-9.81,0]", "[0,-5,0]", "gravity 0 -9.81 0 m/s2",
                         "gravity 0 -5 0 m/s2"}) ==
        "gravity: 0 -9.81 0 m/s² in A, 0 -5 0 m/s² in B");
  CHECK(difference_text({"settings.stepper", "\"event\"", "\"realtime\"", "event", "realtime"}) ==
        "stepper: event in A, realtime in B");
  CHECK(difference_text({"settings.contact_damping_ratio", "1", "2", "contact damping ratio 1",
                         "contact damping ratio 2"}) == "contact damping ratio: 1 in A, 2 in B");
  CHECK(difference_text({"settings.integrator", "\"rk2\"", "\"rk4\"", "rk2", "rk4"}) ==
        "integrator: rk2 in A, rk4 in B");
  CHECK(difference_text({"simd", "", "avx2", "best SIMD", "avx2"}) ==
        "SIMD: best SIMD in A, avx2 in B");
}

TEST_CASE("components that are nothing beside the vector, or the body, are shown as 0") {
  CHECK(shown_vector(Vec3(2, 5.491e-8, -1.344e-6), "m", 0) == Vec3(2, 0, 0));
  CHECK(shown_vector(Vec3(0, -9.81, 1.776e-15), "m/s2", 0) == Vec3(0, -9.81, 0));
  CHECK(shown_vector(Vec3(-1.344e-6, 0, 5.491e-8), "m", 1) == Vec3::Zero());
  // What can be seen stays, in a small world too.
  CHECK(shown_vector(Vec3(2, 1e-4, -3e-4), "m", 1) == Vec3(2, 1e-4, -3e-4));
  CHECK(shown_vector(Vec3(3e-6, 1e-8, 0), "m", 1e-6) == Vec3(3e-6, 1e-8, 0));
  CHECK(shown_vector(Vec3(1e-9, 0, 0), "N", 5) == Vec3(1e-9, 0, 0));
  CHECK_FALSE(std::signbit(shown_vector(Vec3(1, -1e-9, -0.0), "m", 1).y()));
}

// Reference: the contrast of relative luminances by the accessibility guidelines of the web (WCAG
// 2.1), which ask for 4.5 to read text.
TEST_CASE("numbers can be read over the knob of a slider in both themes") {
  UiHost host;
  const auto luminance = [](const ImVec4& c) {
    const auto linear = [](double v) {
      return v <= 0.03928 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(double(c.x)) + 0.7152 * linear(double(c.y)) +
           0.0722 * linear(double(c.z));
  };
  const auto contrast = [&](const ImVec4& a, const ImVec4& b) {
    const auto [low, high] = std::minmax(luminance(a), luminance(b));
    return (high + 0.05) / (low + 0.05);
  };
  const auto over = [](const ImVec4& a, const ImVec4& b) {
    return ImVec4(b.x + a.w * (a.x - b.x), b.y + a.w * (a.y - b.y), b.z + a.w * (a.z - b.z), 1);
  };
  for (const Theme theme : {Theme::light, Theme::dark}) {
    apply_ui_style(theme);
    const ImVec4* c = ImGui::GetStyle().Colors;
    for (const auto& [knob, field] : {std::pair(ImGuiCol_SliderGrab, ImGuiCol_FrameBg),
                                      {ImGuiCol_SliderGrab, ImGuiCol_FrameBgHovered},
                                      {ImGuiCol_SliderGrabActive, ImGuiCol_FrameBgActive}}) {
      const ImVec4 seen = over(c[knob], c[field]);
      CHECK(contrast(seen, c[ImGuiCol_Text]) > 4.5);
      CHECK(contrast(seen, c[field]) > 1.35);  // and the knob is seen
    }
  }
}

TEST_CASE("beside a lesson others keep what they need, and no more") {
  UiState state;
  for (const PanelId id : {PanelId::lesson, PanelId::measure}) state.shows(id) = true;
  state.content_height[size_t(PanelId::lesson)] = 900;
  for (const float plot : {80.0f, 200.0f, 240.0f, 700.0f}) {
    state.content_height[size_t(PanelId::measure)] = plot;
    const auto panels = layout_ui(1280, 720, state).panels;
    REQUIRE(panels.size() == 2);
    CHECK(panels[0].panel->id == PanelId::lesson);
    CHECK(panels[1].rect.height == doctest::Approx(std::min(plot, 240.0f)));
    CHECK(panels[1].rect.y + panels[1].rect.height == doctest::Approx(710));
  }
}

TEST_CASE("text is broken between words only, and numbers stay whole") {
  UiHost host;
  UiDrawList out;
  host.begin(640, 400, 1.0 / 60, {}, false);
  const auto width_of = [](std::string_view s) {
    return ImGui::CalcTextSize(s.data(), s.data() + s.size()).x;
  };
  const std::string text = "each second its speed grows by 9.81 m/s,\nand 1e-3 is .5 of 2e-3.";
  size_t broken = 0;
  for (float width = 0; width < 400; width += 3) {
    const std::string lines = in_lines(text, width);
    REQUIRE(lines.size() == text.size());
    for (size_t i = 0, line = 0; i <= lines.size(); ++i) {
      if (i < lines.size() && lines[i] != text[i]) CHECK((lines[i] == '\n' && text[i] == ' '));
      if (i < lines.size() && lines[i] != '\n') continue;
      const std::string one = lines.substr(line, i - line);
      CHECK((width_of(one) <= width || one.find(' ') == std::string::npos));
      // As much as there is room for.
      const size_t next = i == lines.size() ? i : lines.find_first_of(" \n", i + 1);
      if (i < lines.size() && text[i] == ' ') {
        ++broken;
        CHECK(width_of(std::string_view(text).substr(line, next - line)) > width);
      }
      line = i + 1;
    }
  }
  CHECK(broken > 100);
  host.end(out);
}

TEST_CASE("three numbers in a row keep their places when one of them gets a sign") {
  UiHost host;
  const auto drawn = [&](const Vec3& v) {
    UiDrawList out;
    for (int k = 0; k < 2; ++k) {
      host.begin(640, 400, 1.0 / 60, {}, false);
      ImGui::SetNextWindowSize({292, 100});
      ImGui::Begin("##row", nullptr, ImGuiWindowFlags_NoDecoration);
      vector_row("velocity [m/s]", v, 3);
      ImGui::End();
      host.end(out);
    }
    return out;
  };
  // Four corners of each letter: those of the last two numbers, of ten letters.
  const UiDrawList a = drawn({1, 2, 3}), b = drawn({-71, 2, 3});
  REQUIRE(b.vertices.size() == a.vertices.size() + 8);
  for (size_t i = 1; i <= 40; ++i) {
    CHECK(a.vertices[a.vertices.size() - i].x == b.vertices[b.vertices.size() - i].x);
    CHECK(a.vertices[a.vertices.size() - i].y == b.vertices[b.vertices.size() - i].y);
  }
  // What is too long for that is still there whole.
  CHECK(drawn({-12345, 2, 3}).vertices.size() == a.vertices.size() + 5 * 4);
}

TEST_CASE("the bar over two pictures side by side shows nothing of what is below it") {
  UiHost host;
  UiModel model;
  model.frame = std::make_shared<Frame>();
  const std::vector<SceneItem> scenes;
  const History history;
  const Measures measures;
  const WorldComparison comparison{};
  model.scenes = &scenes;
  model.history = &history;
  model.measures = &measures;
  UiState state;
  const auto least_alpha = [&] {
    UiDrawList out;
    std::vector<UiRequest> requests;
    host.begin(1280, 800, 1.0 / 60, {}, false);
    PanelContext context{host, model, state, requests, 1.0 / 60};
    draw_ui(context, 1280, 800);
    host.end(out);
    uint32_t least = 255;
    for (const auto& v : out.vertices)
      if (v.x == 0 && v.y == 0) least = std::min(least, v.rgba >> 24);
    return least;
  };
  CHECK(least_alpha() < 255);
  model.comparison = &comparison;
  CHECK(least_alpha() < 255);
  state.compared_as = ComparedAs::beside;
  CHECK(least_alpha() == 255);
}
