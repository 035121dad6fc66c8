#include "viewer/capture/video_pipe.hpp"

#include "viewer/capture/atomic_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace tumble {
namespace fs = std::filesystem;
namespace {

/// Video players need even sizes, because chroma has half the resolution.
constexpr const char* even = "pad=ceil(iw/2)*2:ceil(ih/2)*2";

std::vector<std::string> command_line(const std::string& program, const fs::path& file, int width,
                                      int height, Fraction fps) {
  std::vector<std::string> out = {program,
                                  "-hide_banner",
                                  "-loglevel",
                                  "error",
                                  "-y",
                                  "-f",
                                  "rawvideo",
                                  "-pixel_format",
                                  "rgb24",
                                  "-video_size",
                                  fmt::format("{}x{}", width, height),
                                  "-framerate",
                                  fmt::format("{}/{}", fps.num, fps.den),
                                  "-i",
                                  "-"};
  const std::string ending = file.extension().string();
  const auto more = [&out](std::initializer_list<const char*> words) {
    out.insert(out.end(), words.begin(), words.end());
  };
  if (ending == ".mp4" || ending == ".mkv" || ending == ".mov")
    more({"-vf", even, "-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p"});
  if (ending == ".mp4" || ending == ".mov") more({"-movflags", "+faststart"});
  if (ending == ".webm") more({"-vf", even, "-pix_fmt", "yuv420p"});
  out.push_back(file.string());
  return out;
}

int start_process(const std::vector<std::string>& words, int input, int complaints) {
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, 0);
  posix_spawn_file_actions_adddup2(&actions, complaints, 1);
  posix_spawn_file_actions_adddup2(&actions, complaints, 2);
  // Ctrl-C at a terminal must not end ffmpeg: our program ends the video properly.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  pid_t process = -1;
  const int failed = posix_spawn(&process, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  return failed ? -1 : process;
}

}  // namespace

fs::path find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::string all = path ? path : "/usr/bin:/bin";
  size_t begin = 0;
  while (begin <= all.size()) {
    const size_t end = std::min(all.find(':', begin), all.size());
    const fs::path file = fs::path(all.substr(begin, end - begin)) / name;
    std::error_code none;
    if (end > begin && fs::is_regular_file(file, none) && access(file.c_str(), X_OK) == 0)
      return file;
    begin = end + 1;
  }
  return {};
}

Result<std::unique_ptr<VideoPipe>> VideoPipe::start(const fs::path& file, int width, int height,
                                                    Fraction fps) {
  const fs::path program = find_program("ffmpeg");
  if (program.empty())
    return Error{ErrorCode::unsupported,
                 "no video can be made: the program ffmpeg is not installed", file.string(),
                 "install it (apt install ffmpeg), or write pictures, which it can join later"};
  if (file.extension().empty())
    return Error{ErrorCode::invalid_argument, "which kind of video? the name has no ending",
                 file.string(), "write FILE.mp4, .webm, .mkv or .gif"};
  if (const fs::path folder = file.parent_path(); !folder.empty())
    if (Status made = make_folder(folder); !made) return made.error();
  std::unique_ptr<VideoPipe> out(new VideoPipe);
  out->file_ = file;
  out->part_ =
      file.parent_path() / ("." + file.stem().string() + ".part" + file.extension().string());
  out->width_ = width;
  out->height_ = height;
  // A socket instead of a pipe: if ffmpeg has ended, writing returns an error instead of raising a
  // signal.
  int ends[2] = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    return out->failure(std::strerror(errno));
  out->socket_ = ends[0];
  out->complaints_ = memfd_create("ffmpeg", MFD_CLOEXEC);
  out->process_ = start_process(command_line(program.string(), out->part_, width, height, fps),
                                ends[1], out->complaints_);
  close(ends[1]);
  if (out->process_ < 0) return out->failure("ffmpeg cannot be started");
  return out;
}

VideoPipe::~VideoPipe() {
  if (socket_ >= 0) close(socket_);
  wait();
  if (complaints_ >= 0) close(complaints_);
  std::error_code none;
  if (!part_.empty()) fs::remove(part_, none);
}

int VideoPipe::wait() {
  if (process_ < 0) return 0;
  int state = 0;
  while (waitpid(process_, &state, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  return state;
}

/// An error that includes the output of ffmpeg.
Error VideoPipe::failure(std::string what) const {
  std::string said(600, '\0');
  const ssize_t got = complaints_ >= 0 ? pread(complaints_, said.data(), said.size(), 0) : 0;
  said.resize(got > 0 ? size_t(got) : 0);
  while (!said.empty() && said.back() == '\n') said.pop_back();
  if (!said.empty()) what += ": " + said;
  return {ErrorCode::io, "the video was not made: " + what, file_.string(),
          "see whether the folder may be written, and whether ffmpeg knows this kind of file"};
}

Status VideoPipe::add(const Image& rgb) {
  if (rgb.width != width_ || rgb.height != height_ || rgb.channels != 3)
    return failure(fmt::format("a picture of {}x{} in a video of {}x{}", rgb.width, rgb.height,
                               width_, height_));
  const uint8_t* at = rgb.pixels.data();
  size_t left = rgb.pixels.size();
  while (left > 0) {
    const ssize_t sent = send(socket_, at, left, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) {
      // ffmpeg may have stopped reading without ending: it waits for the end of its input, and we
      // for its end.
      close(socket_);
      socket_ = -1;
      (void)wait();  // then all of its output has been read
      return failure("ffmpeg has ended early");
    }
    at += sent;
    left -= size_t(sent);
  }
  return {};
}

Status VideoPipe::finish() {
  if (socket_ >= 0) close(socket_);
  socket_ = -1;
  const int state = wait();
  if (!WIFEXITED(state) || WEXITSTATUS(state) != 0) return failure("ffmpeg has failed");
  std::error_code error;
  fs::rename(part_, file_, error);
  if (error) return failure(error.message());
  part_.clear();
  return {};
}

}  // namespace tumble
