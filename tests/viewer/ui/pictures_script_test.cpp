// Screenshots and sequences of the window by script. Reference: the files that they leave.
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/capture/atomic_file.hpp"
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

namespace {

/// The draw lists of a recording, as its frames.json has them: of the box in a world that runs,
/// with it under the microscope or without.
std::vector<std::string> recorded_pictures(Device& device, const std::string& algorithm) {
  Rig rig(device);
  rig.play("wait 60\nclick transport.pause\nclick body:box\nwait 2");
  if (!algorithm.empty()) {
    rig.play("key M\nwait 2");
    rig.app->ui_state().microscope = {algorithm, 1};
  }
  rig.play("click transport.pause\nkey F9\nwait 5\nkey F9\nwait 2");
  std::vector<std::string> hashes;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(rig.folder.path())) {
    if (entry.path().filename() != "frames.json") continue;
    const auto text = read_file(entry.path());
    REQUIRE(text.ok());
    constexpr std::string_view key = "\"draw_hash\":\"";
    for (size_t at = text->find(key); at != std::string::npos; at = text->find(key, at + 1))
      hashes.push_back(text->substr(at + key.size(), 16));
  }
  return hashes;
}

}  // namespace

TEST_CASE("a sequence shows the microscope, also where the world has to be asked") {
  const auto device = make_null_device();
  const auto plain = recorded_pictures(*device, "");
  REQUIRE(plain.size() >= 5);
  CHECK(recorded_pictures(*device, "") == plain);
  for (const char* algorithm : {"gjk", "dantzig"}) {
    const auto magnified = recorded_pictures(*device, algorithm);
    REQUIRE_MESSAGE(magnified.size() == plain.size(), algorithm);
    for (size_t i = 0; i < plain.size(); ++i)
      CHECK_MESSAGE(magnified[i] != plain[i], algorithm << " in frame " << i);
    CHECK_MESSAGE(recorded_pictures(*device, algorithm) == magnified, algorithm);
  }
}
