// Cameras that fly along keys, in the window and alone; recording to a video. References: the keys
// themselves, straight lines and central differences; a program that stands in for ffmpeg and
// keeps what it is given.
#include "tests/support/why_not.hpp"
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/app/scenes/camera_path.hpp"
#include "viewer/capture/video_pipe.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

CameraKey key_at(double time, const Vec3& eye, const Vec3& target, double fov = 40) {
  CameraKey out{time, {}};
  out.camera.eye = eye;
  out.camera.target = target;
  out.camera.fov_deg = fov;
  return out;
}

/// An ffmpeg that writes its arguments and its input into the file that it was to make.
struct FakeFfmpeg {
  TempFolder folder;
  std::string path = std::getenv("PATH") ? std::getenv("PATH") : "";
  explicit FakeFfmpeg(const std::string& script) {
    const auto file = folder / "ffmpeg";
    std::ofstream(file) << "#!/bin/sh\n" << script;
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    setenv("PATH", (folder.path().string() + ":" + path).c_str(), 1);
  }
  ~FakeFfmpeg() { setenv("PATH", path.c_str(), 1); }
};
const char* keeps = "for last; do :; done\n{ echo \"$@\"; cat; } > \"$last\"\n";

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream out;
  out << std::ifstream(file, std::ios::binary).rdbuf();
  return out.str();
}

}  // namespace

TEST_CASE("a flight goes through its keys, smoothly, and rests at its ends") {
  const std::vector<CameraKey> path = {
      key_at(1, {0, 0, 9}, {0, 0, 0}), key_at(2, {4, 0, 9}, {0, 1, 0}, 30),
      key_at(5, {4, 6, 0}, {1, 1, 1}), key_at(6, {0, 6, 0}, {0, 0, 1}, 50)};
  for (const CameraKey& k : path) {
    CHECK(camera_at(path, k.time).eye.isApprox(k.camera.eye, 1e-12));
    CHECK(camera_at(path, k.time).fov_deg == doctest::Approx(k.camera.fov_deg));
  }
  CHECK(camera_at(path, 0).eye == path[0].camera.eye);
  CHECK(camera_at(path, 99).eye == path[3].camera.eye);
  const double h = 1e-6;
  for (const double t : {1.0, 2.0, 5.0, 6.0}) {
    const Vec3 before = (camera_at(path, t).eye - camera_at(path, t - h).eye) / h;
    const Vec3 after = (camera_at(path, t + h).eye - camera_at(path, t).eye) / h;
    CHECK((before - after).norm() < 1e-4);
  }
  // On a straight line at equal speed the inner piece stays on it.
  const std::vector<CameraKey> line = {
      key_at(0, {0, 0, 0}, {0, 0, 1}), key_at(1, {1, 0, 0}, {0, 0, 1}),
      key_at(2, {2, 0, 0}, {0, 0, 1}), key_at(3, {3, 0, 0}, {0, 0, 1})};
  for (double t = 1; t <= 2; t += 0.1) CHECK(camera_at(line, t).eye.x() == doctest::Approx(t));
  CHECK(camera_at({key_at(3, {1, 2, 3}, {0, 0, 0})}, 1).eye == Vec3(1, 2, 3));
}

TEST_CASE("keys that follow a body carry a flight along with it, or from one to a fixed place") {
  std::vector<CameraKey> path = {key_at(0, {0, 0, 9}, {0, 0, 0}), key_at(2, {4, 0, 9}, {0, 1, 0})};
  for (CameraKey& key : path) {
    key.follow = "ball";
    key.follow_x = Vec3(1, 0, 0);
  }
  const auto at = [](const Vec3& x) {
    return [x](const std::string& name) -> std::optional<Vec3> {
      return name == "ball" ? std::optional(x) : std::nullopt;
    };
  };
  // With all keys on one body the whole flight is shifted by what that has moved.
  const Vec3 shift(3, 5, -2);
  const auto carried = carried_along(path, at(path[0].follow_x + shift));
  for (const double t : {0.0, 0.7, 1.5, 2.0}) {
    CHECK(camera_at(carried, t).eye.isApprox(camera_at(path, t).eye + shift, 1e-12));
    CHECK(camera_at(carried, t).target.isApprox(camera_at(path, t).target + shift, 1e-12));
  }
  // With one it comes from the moving body to rest, and half way it is half carried.
  path[1].follow.clear();
  const auto leaving = carried_along(path, at(path[0].follow_x + shift));
  CHECK(camera_at(leaving, 0).eye.isApprox(path[0].camera.eye + shift, 1e-12));
  CHECK(camera_at(leaving, 1).eye.isApprox(camera_at(path, 1).eye + 0.5 * shift, 1e-12));
  CHECK(camera_at(leaving, 2).eye == path[1].camera.eye);
  path[0].follow = "gone";
  CHECK(carried_along(path, at(shift))[0].camera.eye == path[0].camera.eye);
}

TEST_CASE(
    "the window flies along the scene's path until somebody takes the camera, and C goes on") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  const auto file = rig.folder / "flight.json";
  std::ofstream(file)
      << R"({"tumble_scene": 1, "bodies": {"ball": {"shape": {"type": "sphere", "radius": 0.5},
    "position": [0, 1, 0], "gravity_scale": 0}}, "cameras": {"main": {"path": [
      {"time": 0, "position": [0, 3, 9], "target": [0, 1, 0]}, {"time": 1, "position": [9, 3, 0], "target": [0, 1, 0]}]}}})";
  rig.app->open(file.string());
  rig.play("key Space\nwait 2");
  rig.app->ask(SeekTick{30});
  rig.play("wait 3");
  CHECK(rig.app->camera().camera().eye.isApprox(Vec3(4.5, 3, 4.5), 1e-6));
  rig.app->ask(SeekTick{60});
  rig.play("wait 3");
  CHECK(rig.app->camera().camera().eye.isApprox(Vec3(9, 3, 0), 1e-6));
  rig.play("drag 200,500 60 0\nwait 40");
  rig.app->ask(SeekTick{0});
  rig.play("wait 3");
  CHECK((rig.app->camera().camera().eye - Vec3(0, 3, 9)).norm() > 1);
  rig.play("key C\nwait 3");
  CHECK(rig.app->camera().camera().eye.isApprox(Vec3(0, 3, 9), 1e-6));
  check_no_faults(*device);
}

TEST_CASE("a video gets every picture once, in order, and appears whole") {
  const FakeFfmpeg program(keeps);
  const auto file = program.folder / "out/a.mp4";
  auto video = VideoPipe::start(file, 3, 2, {30, 1});
  REQUIRE_MESSAGE(video.ok(), test::why_not(video));
  std::string expected;
  for (int k = 0; k < 50; ++k) {
    Image image{3, 2, 3, std::vector<uint8_t>(18)};
    for (size_t i = 0; i < 18; ++i) image.pixels[i] = uint8_t(k + int(i));
    expected.append(image.pixels.begin(), image.pixels.end());
    REQUIRE((*video)->add(image));
  }
  CHECK_FALSE((*video)->add(Image{2, 2, 3, std::vector<uint8_t>(12)}));
  CHECK_FALSE(std::filesystem::exists(file));
  REQUIRE((*video)->finish());
  const std::string text = text_of(file);
  const size_t line = text.find('\n');
  CHECK(text.substr(line + 1) == expected);
  CHECK(text.substr(0, line).find("-video_size 3x2 -framerate 30/1 -i -") != std::string::npos);
}

TEST_CASE("a video that fails leaves nothing and says why") {
  TempFolder folder;
  const auto file = folder / "a.mp4";
  const Image image{64, 64, 3, std::vector<uint8_t>(64 * 64 * 3)};
  const auto fails = [&](const char* script, std::string_view words) {
    const FakeFfmpeg program(script);
    auto video = VideoPipe::start(file, 64, 64, {30, 1});
    REQUIRE(video.ok());
    Status status;
    for (int k = 0; k < 200 && status; ++k) status = (*video)->add(image);
    if (status) status = (*video)->finish();
    REQUIRE_FALSE(status.ok());
    CHECK_MESSAGE(status.error().text().find(words) != std::string::npos, status.error().text());
    video->reset();
    CHECK(std::filesystem::is_empty(folder.path()));
  };
  fails("echo 'no such codec' >&2\nexit 1\n", "no such codec");
  fails("cat > /dev/null\nexit 3\n", "ffmpeg has failed");
  {
    const FakeFfmpeg program("cat > /dev/null\n");
    CHECK_FALSE(VideoPipe::start(folder / "noending", 4, 4, {30, 1}).ok());
    auto given_up = VideoPipe::start(file, 64, 64, {30, 1});
    REQUIRE(given_up.ok());
    given_up->reset();
    CHECK_FALSE(std::filesystem::exists(file));
  }
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  const auto none = VideoPipe::start(file, 4, 4, {30, 1});
  setenv("PATH", path.c_str(), 1);
  REQUIRE_FALSE(none.ok());
  CHECK(none.error().text().find("ffmpeg is not installed") != std::string::npos);
  CHECK(none.error().text().find("apt install ffmpeg") != std::string::npos);
}

TEST_CASE("Shift+F9 records a video from the window, or says that ffmpeg is missing") {
  const auto device = make_null_device();
  Rig rig(*device);
  {
    const FakeFfmpeg program(keeps);
    rig.play("key Shift+F9\nwait 12\nkey F9\nwait 3");
    CHECK_FALSE(rig.app->recording());
    const auto file = rig.folder / "tumble-first-video-000.mp4";
    REQUIRE(std::filesystem::exists(file));
    const std::string text = text_of(file);
    const size_t pixels = text.size() - text.find('\n') - 1;
    CHECK(pixels % (800 * 500 * 3) == 0);
    CHECK(pixels / (800 * 500 * 3) >= 8);
    CHECK_FALSE(std::filesystem::exists(rig.folder / "frames.json"));
  }
  const std::string path = std::getenv("PATH");
  setenv("PATH", rig.folder.path().c_str(), 1);
  rig.play("key Shift+F9\nwait 3");
  setenv("PATH", path.c_str(), 1);
  CHECK_FALSE(rig.app->recording());
  CHECK(says(rig, "No video"));
  CHECK(says(rig, "apt install ffmpeg"));
  check_no_faults(*device);
}
