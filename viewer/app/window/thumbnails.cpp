#include "viewer/app/window/thumbnails.hpp"

#include "engine/core/hash.hpp"
#include "engine/scene/resources.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/frames_file.hpp"
#include "viewer/capture/png.hpp"

#include <algorithm>
#include <csignal>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace tumble {
namespace fs = std::filesystem;
namespace {

/// To be increased when thumbnails should look different from cached ones.
constexpr int look_version = 1;
constexpr std::chrono::seconds longest_render(120);

int start_render(const fs::path& program, const std::string& scene, const fs::path& to) {
  const std::string size = fmt::format("{}x{}", Thumbnails::width, Thumbnails::height);
  const std::string words[] = {
      program.string(), "render", scene,       "-o", to.string(), "--frames", "1",
      "--size",         size,     "--threads", "1",  "--quiet",   "--force"};
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (int fd = 0; fd <= 2; ++fd)
    posix_spawn_file_actions_addopen(&actions, fd, "/dev/null", fd ? O_WRONLY : O_RDONLY, 0);
  pid_t process = 0;
  const int failed = posix_spawn(&process, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed) return 0;
  // The window and its simulation have priority.
  (void)setpriority(PRIO_PROCESS, id_t(process), 5);
  return process;
}

}  // namespace

fs::path Thumbnails::usual_folder() {
  const fs::path cache = user_folder("XDG_CACHE_HOME", ".cache");
  return cache.empty() ? fs::path() : cache / "tumble" / "thumbnails";
}

Thumbnails::~Thumbnails() {
  if (process_ <= 0) return;
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
  std::error_code none;
  fs::remove_all(work_, none);
}

/// Named by the hash of the scene's file, so that a changed scene gets a new thumbnail.
fs::path Thumbnails::file_of(const SceneItem& item) {
  if (const auto known = files_.find(item.name); known != files_.end()) return known->second;
  fs::path file;
  if (const auto text = read_file(item.file))
    file = folder_ / (hash_text(hash_bytes(text->data(), text->size(), look_version)) + ".png");
  return files_[item.name] = file;
}

void Thumbnails::look_again(const std::vector<SceneItem>& scenes) {
  for (const SceneItem& item : scenes) {
    const auto known = files_.find(item.name);
    if (known == files_.end() || (process_ > 0 && item.name == making_)) continue;
    const fs::path before = known->second;
    files_.erase(known);
    if (file_of(item) == before) continue;
    pictures_.erase(item.name);
    failed_.erase(item.name);
  }
}

bool Thumbnails::load(const SceneItem& item, Renderer& renderer) {
  const fs::path file = file_of(item);
  std::error_code none;
  if (file.empty() || !fs::exists(file, none)) return false;
  auto image = read_image(file);
  if (!image || image->width != width || image->height != height) {
    fs::remove(file, none);
    return false;
  }
  if (image->channels == 3) {
    Image with_alpha{image->width, image->height, 4, {}};
    for (size_t i = 0; i < image->pixels.size(); i += 3)
      with_alpha.pixels.insert(with_alpha.pixels.end(),
                               {image->pixels[i], image->pixels[i + 1], image->pixels[i + 2], 255});
    *image = std::move(with_alpha);
  }
  pictures_[item.name] = renderer.add_ui_texture(*image);
  return true;
}

void Thumbnails::begin(const SceneItem& item) {
  const fs::path file = file_of(item);
  if (file.empty() || !make_folder(folder_)) {
    failed_.insert(item.name);
    return;
  }
  work_ = folder_ / fmt::format("{}.{}", file.stem().string(), getpid());
  making_ = item.name;
  since_ = std::chrono::steady_clock::now();
  process_ = start_render(program_, item.file, work_);
  if (process_ <= 0) end_process(false);
}

void Thumbnails::end_process(bool good) {
  std::error_code error;
  if (good) fs::rename(work_ / frame_name(0), files_[making_], error);
  if (!good || error) failed_.insert(making_);
  if (good && !error) ++made_;
  fs::remove_all(work_, error);
  process_ = 0;
}

void Thumbnails::look_after_process() {
  int state = 0;
  const int ended = waitpid(process_, &state, WNOHANG);
  if (ended == 0) {
    if (std::chrono::steady_clock::now() - since_ > longest_render) kill(process_, SIGKILL);
    return;
  }
  end_process(ended == process_ && WIFEXITED(state) && WEXITSTATUS(state) == 0);
}

void Thumbnails::update(const std::vector<SceneItem>& scenes, const std::vector<std::string>& seen,
                        Renderer& renderer) {
  if (process_ > 0) look_after_process();
  if (folder_.empty()) return;
  for (const std::string& name : seen) {
    if (pictures_.contains(name) || failed_.contains(name)) continue;
    const auto item = std::ranges::find(scenes, name, &SceneItem::name);
    if (item == scenes.end() || item->file.empty()) continue;
    if (name == making_ && process_ > 0) continue;
    if (load(*item, renderer)) return;  // at most one per picture
    if (process_ > 0 || program_.empty()) continue;
    return begin(*item);
  }
}

}  // namespace tumble
