// `tumble render --video`. Reference: a program in the place of ffmpeg that keeps what it gets.
// Needs a renderer (EGL or OSMesa).
#include "tests/viewer/cli/program.hpp"

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("render --video hands every picture to ffmpeg, or says that there is none") {
  TempFolder folder;
  const std::string scene = write_text(folder / "s.json", small_scene());
  const std::string video = (folder / "v.mp4").string();
  const auto program = folder / "ffmpeg";
  write_text(program, "#!/bin/sh\nfor last; do :; done\nexec /bin/cat > \"$last\"\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const auto with_path = [](const std::string& path) {
    ProgramOptions options;
    options.environment = {{"PATH", path}};
    return options;
  };
  const std::vector<std::string> line = {"render", scene,    "--video", video,    "--frames",
                                         "3",      "--size", "64x48",   "--quiet"};
  const ProgramRun none = tumble_program(line, with_path("/nowhere"));
  CHECK(none.code == 5);
  CHECK(none.err.find("ffmpeg is not installed") != std::string::npos);
  const ProgramRun run = tumble_program(line, with_path(folder.path().string() + ":/usr/bin:/bin"));
  REQUIRE_MESSAGE(run.code == 0, run.err);
  CHECK(std::filesystem::file_size(video) == 3 * 64 * 48 * 3);
  CHECK(tumble_program(line, with_path(folder.path().string())).code == 5);
  CHECK(tumble_program({"render", scene, "--frames", "1"}).code == 2);
}
