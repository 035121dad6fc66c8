// Screenshots and sequences of the window by script. Reference: the files that they leave.
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/capture/png.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

TEST_CASE("snapshot and back, delete and screenshots") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 20\nkey Space\nkey F5");
  const uint64_t kept = rig.tick();
  const double height = rig.height("ball");
  rig.play("key Space\nwait 30\nkey Space\nkey F7\nwait 2");
  CHECK(rig.tick() == kept);
  CHECK(rig.height("ball") == height);
  const auto bodies = rig.app->view().to->stats.bodies;
  rig.play("click body:box\nkey Del\nwait 2\nkey F12\nkey Ctrl+F12\nwait 2");
  CHECK(rig.height("box") == -1);
  CHECK(bodies == 3);
  REQUIRE(rig.app->captured().size() == 2);
  for (const auto& path : rig.app->captured()) {
    const auto image = read_image(path);
    REQUIRE(image.ok());
    CHECK(image->width == 800);
    CHECK(image->height == 500);
  }
}

TEST_CASE("a sequence keeps its size while the window changes, and ends whole with the program") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 5\nkey F9\nwait 3");
  rig.picture = {501, 333, 1};
  rig.play("wait 3");
  CHECK(rig.app->recording());
  rig.app->finish();
  CHECK_FALSE(rig.app->recording());
  size_t pictures = 0, lists = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(rig.folder.path())) {
    lists += entry.path().filename() == "frames.json";
    if (entry.path().extension() != ".png") continue;
    ++pictures;
    const auto image = read_image(entry.path());
    REQUIRE(image.ok());
    CHECK(image->width == 800);
    CHECK(image->height == 500);
  }
  CHECK(pictures >= 6);
  CHECK(lists == 1);
}

TEST_CASE("a sequence has one frame a sixtieth of a second and goes on where it was") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 5\nkey F9\nwait 9\nkey F9\nwait 2");
  size_t pictures = 0;
  bool told = false;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(rig.folder.path())) {
    if (entry.path().extension() == ".png") ++pictures;
    if (entry.path().filename() == "frames.json") told = true;
  }
  CHECK(pictures >= 9);
  CHECK(told);
  CHECK_FALSE(rig.app->session().paused());
}
