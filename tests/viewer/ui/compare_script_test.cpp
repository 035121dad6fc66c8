// Reference: worlds that are stepped by hand with the same settings and the same commands.
#include "engine/dynamics/simd/simd_target.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/reader.hpp"
#include "engine/world/world.hpp"
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/app/session/second_world.hpp"
#include "viewer/app/verify/differences.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

WorldChoice choice_of(const WorldSettings& settings) {
  WorldChoice choice;
  choice.settings = settings;
  return choice;
}

/// A ball over a floor, and as many marbles beside it as the scene has numbers for.
constexpr std::string_view numbered_scene = R"({"tumble_scene": 1,
  "parameters": {"height": {"value": 2, "min": 1, "max": 9}, "marbles": 2, "g": 9.81},
  "settings": {"gravity": [0, "= -g", 0]},
  "bodies": {
    "floor": {"type": "static", "shape": {"type": "half_space"}},
    "marble": {"shape": {"type": "sphere", "radius": 0.1}, "position": [3, 0.1, 0],
               "repeat": {"type": "stack", "count": "$marbles", "step": [0.5, 0, 0]}},
    "ball": {"shape": {"type": "sphere", "radius": 0.2}, "position": [0, "$height", 0]}}})";

/// The window with that scene, which runs for so many ticks.
struct NumberedRig {
  std::unique_ptr<Device> device = make_null_device();
  Rig rig{*device};

  explicit NumberedRig(int ticks) {
    rig.picture = {1400, 1600, 1};
    const std::string file = (rig.folder.path() / "numbers.json").string();
    REQUIRE(write_file(file, numbered_scene).ok());
    rig.app->session().set_paused(true);
    rig.app->open(file);
    rig.play("wait 3\nkey K\nwait 2");
    REQUIRE(rig.app->session().advance(uint64_t(ticks)).ok());
    rig.play("wait 3");
  }
  WorldChoice choice() const {
    WorldChoice out = choice_of(rig.app->settings());
    out.threads = 1;
    out.numbers = {{"height", 2}, {"marbles", 2}, {"g", 9.81}};
    return out;
  }
  void compare(const WorldChoice& choice) {
    rig.app->ask(Compare{choice});
    rig.play("wait 3");
    REQUIRE(rig.app->comparison());
  }
  const WorldComparison& seen() const { return *rig.app->comparison(); }
  void run(int ticks) {
    REQUIRE(rig.app->session().advance(uint64_t(ticks)).ok());
    rig.play("wait 2");
  }
};

}  // namespace

TEST_CASE("with another number of the scene both begin at the start, and keep their distance") {
  NumberedRig w(40);
  CHECK(w.rig.tick() == 40);
  WorldChoice choice = w.choice();
  choice.numbers[0].second = 3;
  w.compare(choice);
  CHECK(w.rig.tick() == 0);
  CHECK(w.seen().from_start);
  CHECK_FALSE(w.seen().alone);
  REQUIRE(w.seen().differences.size() == 1);
  CHECK(w.seen().differences[0].path == "parameters.height");
  CHECK(w.seen().differences[0].value_a == "2");
  CHECK(w.seen().differences[0].value_b == "3");
  REQUIRE(w.rig.app->ui().find("compare.differs.parameters.height"));
  w.run(30);  // both fall all the while
  CHECK(w.seen().first_tick == 0);
  CHECK(w.seen().first_what == "ball");
  CHECK(w.seen().distance == doctest::Approx(1).epsilon(1e-12));
  // A pull at A is one at B, for they are made alike.
  World& a = w.rig.app->session().world();
  REQUIRE(a.apply_impulse(a.find_body("ball"), Vec3(50, 0, 0), Vec3(0, 1, 0)).ok());
  w.run(5);
  CHECK(w.rig.app->comparison()->distance == doctest::Approx(1).epsilon(1e-3));
  // Undone, both are what they were.
  w.rig.play("key Ctrl+Z\nwait 3");
  check_no_faults(*w.device);
}

TEST_CASE("a number that the settings follow is followed, and a setting stays beside it") {
  NumberedRig w(3);
  WorldChoice choice = w.choice();
  choice.numbers[2].second = 1;
  choice.settings.realtime.substeps = 7;
  w.compare(choice);
  CHECK(w.seen().choice.settings.gravity.now().y() == -1);
  CHECK(w.seen().choice.settings.realtime.substeps == 7);
  CHECK(w.seen().differences.size() == 3);  // gravity, substeps, g
  w.run(20);
  const double t = 20.0 / 60;
  CHECK(w.seen().distance == doctest::Approx(0.5 * 8.81 * t * t).epsilon(0.06));
  check_no_faults(*w.device);
}

TEST_CASE("bodies of another count are told apart by name, and what is done to A stays with it") {
  NumberedRig w(3);
  WorldChoice choice = w.choice();
  choice.numbers[1].second = 3;
  w.compare(choice);
  CHECK(w.seen().alone);
  w.run(2);
  REQUIRE(w.seen().first_tick);
  CHECK(w.seen().first_what == "marble[2]");
  World& a = w.rig.app->session().world();
  const BodyId ball = a.find_body("ball");
  REQUIRE(a.apply_impulse(ball, Vec3(50, 0, 0), a.body(ball)->pose.x).ok());
  w.run(4);
  // Of B's ball, whose slot is another, nothing was done: what only one has is farther all the
  // same.
  CHECK(std::isinf(w.seen().distance));
  CHECK(w.seen().angle == 0);
  check_no_faults(*w.device);
}

TEST_CASE("other threads and another instruction set are listed, and nothing parts by them") {
  NumberedRig w(0);
  WorldChoice choice = w.choice();
  choice.threads = 2;
  choice.simd = simd_targets().back();
  w.compare(choice);
  REQUIRE(w.seen().differences.size() == 2);
  CHECK(w.seen().differences[0].path == "threads");
  CHECK(w.seen().differences[1].path == "simd");
  w.run(60);
  CHECK_FALSE(w.seen().first_tick);
  CHECK(w.seen().fault.empty());
  check_no_faults(*w.device);
}

TEST_CASE("the first contact that differs is named, and looked into") {
  NumberedRig w(30);  // the marbles lie on the floor
  WorldChoice choice = w.choice();
  choice.settings.gravity = Vec3(0, -5, 0);
  w.compare(choice);
  w.run(2);
  REQUIRE(w.seen().first_contact);
  const std::string words = w.seen().first_contact->what;
  CHECK_MESSAGE(words.find("marble[0]") != std::string::npos, words);
  CHECK_MESSAGE(words.find("floor") != std::string::npos, words);
  w.rig.play("click compare.contact\nwait 4");
  CHECK(w.rig.tick() == *w.seen().first_tick);
  CHECK(w.rig.app->contact());
  check_no_faults(*w.device);
}

TEST_CASE("what is listed as different makes the other world of the scene") {
  WorldChoice a, b;
  b.settings.stepper = "event";
  b.settings.gravity = Vec3(0.25, -1.6, 1e-3);
  b.settings.tick = {240, 7};
  b.settings.realtime.sleeping = !a.settings.realtime.sleeping;
  b.settings.event.integrator = "rk45";
  b.threads = 3;
  const auto found = differences(a, b);
  CHECK(found.size() == 6);
  const auto overrides = overrides_of(found);
  CHECK(overrides.size() == 5);
  ReadOptions options;
  options.overrides = overrides;
  const SceneRead read = read_scene(R"({"tumble_scene": 1})", "x.json", options);
  REQUIRE(read.ok());
  const auto built = build_world(read.scene, {});
  REQUIRE(built.ok());
  CHECK(changed_settings(built->world->settings(), b.settings).empty());
  CHECK(changed_settings(built->world->settings(), a.settings).size() == 5);
}

TEST_CASE("a second world with equal settings keeps the same bits, whatever is done to the first") {
  TestWorld a;
  BodyDef box = TestWorld::box_def({0, 2, 0});
  box.name = "box";
  const BodyId id = a.add(box);
  SecondWorld second(choice_of(a->settings()));
  second.begin(*a.world);
  for (int i = 0; i < 60; ++i) {
    if (i == 20) CHECK(a->apply_impulse(id, Vec3(500, 200, 0), Vec3(0, 2, 0.2)).ok());
    REQUIRE(a->step().ok());
    second.follow(*a.world);
  }
  CHECK(second.shown().to->tick == a->tick());
  CHECK(second.shown().samples.size() == 61);
  CHECK_FALSE(second.shown().first);
  CHECK(second.shown().worst.distance == 0);
  CHECK(second.shown().fault.empty());
}

TEST_CASE("other settings part, from the first tick in which they matter") {
  TestWorld a;
  BodyDef box = TestWorld::box_def({0, 2, 0});
  box.name = "box";
  (void)a.add(box);
  WorldSettings settings = a->settings();
  settings.gravity = Vec3(0, -1, 0);
  SecondWorld second(choice_of(settings));
  REQUIRE(a->apply_commands().ok());
  second.begin(*a.world);
  for (int i = 0; i < 30; ++i) {
    REQUIRE(a->step().ok());
    second.follow(*a.world);
  }
  const SecondWorld::Shown shown = second.shown();
  REQUIRE(shown.first);
  CHECK(shown.first->tick_a == 1);
  CHECK(shown.first->what == "box");
  // Two falls, apart by (g - 1) t^2 / 2 but for the scheme's first-order term.
  const double t = shown.now.time, g = -a->settings().gravity.now().y();
  const double expected = 0.5 * (g - 1) * t * t;
  CHECK(shown.now.distance == doctest::Approx(expected).epsilon(0.05));
  CHECK(shown.worst.distance == shown.now.distance);
}

TEST_CASE("a world of half the tick is compared at the moments that both have") {
  TestWorld a;
  (void)a.add(TestWorld::box_def({0, 2, 0}));
  WorldSettings settings = a->settings();
  settings.tick.num *= 2;
  SecondWorld second(choice_of(settings));
  REQUIRE(a->apply_commands().ok());
  second.begin(*a.world);
  const uint64_t begun = second.shown().to->tick;
  for (int i = 0; i < 10; ++i) {
    REQUIRE(a->step().ok());
    second.follow(*a.world);
  }
  CHECK(second.shown().to->tick - begun == 20);
  CHECK(second.shown().samples.size() == 11);
}

TEST_CASE("a second world far behind catches up in slices, and comes to the same bits") {
  TestWorld a;
  BodyDef box = TestWorld::box_def({0, 2, 0});
  box.name = "box";
  const BodyId id = a.add(box);
  REQUIRE(a->apply_commands().ok());
  const auto start = World::create({});
  REQUIRE(start.ok());
  REQUIRE((*start)->load(a->save()).ok());
  for (int i = 0; i < 40; ++i) {
    if (i == 20) CHECK(a->apply_impulse(id, Vec3(500, 200, 0), Vec3(0, 2, 0.2)).ok());
    REQUIRE(a->step().ok());
  }
  // It begins at the first tick: each slice of no time at all is one tick of it.
  SecondWorld second(choice_of(a->settings()), **start);
  second.begin(*a.world, 0);
  for (int ticks = 1; ticks < 40; ++ticks) {
    CHECK(second.behind(*a.world));
    CHECK(second.shown().to->tick == uint64_t(ticks));
    CHECK(second.shown().behind == doctest::Approx((40 - ticks) * a->settings().tick.tick()));
    second.follow(*a.world, 0);
  }
  CHECK_FALSE(second.behind(*a.world));
  CHECK(second.shown().behind == 0);
  CHECK(second.shown().now.same_bits);
  // Going back to where it has been is none of that.
  SecondWorld slow(choice_of(a->settings()), **start);
  slow.begin(*a.world, 0);
  slow.go_back(*a.world, 0);
  CHECK(slow.shown().to->tick == 2);
}

TEST_CASE("the window compares, shows where worlds part, and goes there") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1400, 900, 1};
  rig.play("wait 3\nkey Space\nkey K\nwait 3\nclick compare.start\nwait 3");
  REQUIRE(rig.app->comparison());
  const size_t alone = rig.app->picture().instances.size();
  CHECK(alone == 2);  // box and ball: no ghost covers what it does not differ from
  rig.play("key Space\nwait 30\nkey Space\nwait 3");
  CHECK_FALSE(rig.app->comparison()->first_tick);
  WorldSettings settings = rig.app->settings();
  settings.gravity = Vec3(0, -3, 0);
  rig.app->ask(Compare{choice_of(settings)});
  rig.play("wait 3");
  const uint64_t from = rig.tick();
  rig.play("key Space\nwait 20\nkey Space\nwait 3");
  REQUIRE(rig.app->comparison()->first_tick);
  CHECK(*rig.app->comparison()->first_tick == from + 1);
  CHECK(rig.app->comparison()->distance > 0);
  CHECK(rig.app->picture().instances.size() > alone);
  const double apart = rig.app->comparison()->worst;
  REQUIRE(rig.app->ui().find("compare.differs.settings.gravity"));
  rig.play("click compare.go_there\nwait 3");
  // A hair apart the ghost is wholly behind what it nearly coincides with, at the same place.
  const RenderScene& picture = rig.app->picture();
  REQUIRE(picture.instances.size() > alone);
  const Vec3f eye = picture.camera.eye.cast<float>();
  for (size_t i = alone; i < picture.instances.size(); ++i) {
    const Vec3f ghost = picture.instances[i].transform.offset - eye;
    float nearest = 1e9f, farther = 0, aside = 1e9f;
    for (size_t k = 0; k < alone; ++k) {
      const Vec3f of_a = picture.instances[k].transform.offset - eye;
      if ((ghost - of_a).norm() >= nearest) continue;
      nearest = (ghost - of_a).norm();
      farther = (ghost.norm() - of_a.norm()) / of_a.norm();
      aside = ghost.cross(of_a).norm() / of_a.squaredNorm();
    }
    CHECK(farther > 1e-3f);
    CHECK(aside < 1e-3f);
  }
  CHECK(rig.tick() == from + 1);
  CHECK(rig.app->comparison()->distance < apart);
  CHECK(rig.app->comparison()->distance > 0);
  // On again both come to where they were.
  rig.play("key Space\nwait 19\nkey Space\nwait 3");
  CHECK(rig.app->comparison()->worst >= 0.9 * apart);
  rig.play("click compare.end\nwait 3");
  CHECK_FALSE(rig.app->comparison());
  CHECK(rig.app->picture().instances.size() == alone);
  check_no_faults(*device);
}

TEST_CASE("halves of a picture are equally wide, between the panels, in whole pixels") {
  const ViewArea whole(1280, 720, 2);
  CHECK(whole.width() == 640);
  CHECK(whole.aspect() == doctest::Approx(1280.0 / 720));
  CHECK(whole.origin_at(500) == 0);
  const ViewArea area = ViewArea::beside(1280, 720, 2, UiRect{310, 56, 320, 290});
  REQUIRE(area.places());
  CHECK(area.left() == 302);  // where a panel of 292 ends that stands 10 from the edge
  CHECK(area.right() + area.width() == 640);
  CHECK(area.left() + area.width() < area.right());
  CHECK(area.origin_at(303) == area.left());
  CHECK(area.origin_at(639) == area.right());
  // Without room between the panels it takes the whole window.
  const ViewArea narrow = ViewArea::beside(600, 400, 1, UiRect{300, 56, 20, 290});
  CHECK(narrow.left() == 0);
  CHECK(narrow.right() + narrow.width() == 600);
  // As much is seen from left to right as in the whole window.
  CHECK(whole.heightening() == 1);
  CHECK(area.heightening() == doctest::Approx(640 / area.width()));
}

TEST_CASE("worlds are called by what differs in them") {
  WorldChoice a, b;
  const auto names = [&] { return names_by(differences(a, b)); };
  CHECK(names().first.empty());
  a.settings.stepper = "event";
  b.settings.stepper = "realtime";
  CHECK(names() == std::pair<std::string, std::string>("event", "realtime"));
  b.settings.gravity = Vec3(0, -1.5, 0);
  CHECK(names().second.find("0 -1.5 0") != std::string::npos);
  b.settings.tick.num *= 2;
  CHECK(names().second.find("and 1 more") != std::string::npos);
}

TEST_CASE("the second world has a picture of its own, with the same camera, and A is worked on") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  rig.play("wait 3\nkey Space\nkey Shift+K\nwait 2");
  CHECK(says(rig, "Nothing is compared yet"));
  rig.play("click compare.start\nwait 3");
  const size_t with_ghost = rig.app->picture().instances.size();
  const uint32_t passes = rig.app->report().draws.passes;
  const Camera whole = rig.app->picture().camera;
  const double at_whole = rig.app->locate("body:ball")->x / 1280;
  rig.play("click compare.beside\nwait 3");
  REQUIRE(rig.app->area().places());
  CHECK(rig.app->picture().instances.size() == with_ghost);
  CHECK((rig.app->locate("body:ball")->x - rig.app->area().left()) / rig.app->area().width() ==
        doctest::Approx(at_whole).epsilon(1e-3));
  CHECK(rig.app->picture().camera.fov_deg > whole.fov_deg);
  CHECK(rig.app->camera().camera().fov_deg == whole.fov_deg);
  CHECK(rig.app->report().draws.passes > passes);
  Image image;
  REQUIRE(rig.app->read_back(image).ok());
  CHECK(image.width == 1280);
  // What is clicked on the left is A's; its fellow on the right is the same body.
  rig.play("click body:box\nwait 3");
  CHECK(rig.app->selected() == rig.app->session().world().find_body("box"));
  rig.play("key Esc\nwait 3");
  REQUIRE(rig.app->selected().is_null());
  const ViewArea area = rig.app->area();
  const auto at = *rig.app->locate("body:box");
  const double aside = area.right() - area.left();
  const auto spot = [](double x, double y) {
    return std::to_string(int(x)) + "," + std::to_string(int(y));
  };
  rig.play("click " + spot(at.x + aside, at.y) + "\nwait 3");
  CHECK_FALSE(rig.app->selected().is_null());
  // A drag there turns the camera of both, and pulls nobody.
  const Vec3 eye = rig.app->camera().camera().eye;
  rig.play("key Esc\nwait 2\ndrag " + spot(at.x + aside, at.y) + " 60 0\nwait 20");
  CHECK((rig.app->camera().camera().eye - eye).norm() > 0.1);
  CHECK_FALSE(rig.app->dragging());
  // Nor is anything shot into A from there.
  const size_t bodies = rig.app->session().world().frame()->body_slots();
  rig.play("shift_click " + spot(at.x + aside, at.y) + "\nwait 3");
  CHECK(rig.app->session().world().frame()->body_slots() == bodies);
  CHECK(says(rig, "only looked at"));
  rig.play("key Shift+K\nwait 2");
  CHECK_FALSE(rig.app->area().places());
  CHECK(rig.app->ui_state().compared_as == ComparedAs::hidden);
  rig.play("key Shift+K\nwait 2");
  CHECK(rig.app->picture().instances.size() == with_ghost);
  check_no_faults(*device);
}
