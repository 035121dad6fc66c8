#include "viewer/app/editing/unsaved_work.hpp"

#include "engine/core/hash.hpp"
#include "engine/scene/resources.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <chrono>
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace tumble {
namespace fs = std::filesystem;
namespace {

/// What a held widget changes comes with every picture: looked at as often as this [s].
constexpr double seconds_between_looks = 1;

/// For an answer of the session: in a tick that takes longer it is left.
constexpr std::chrono::milliseconds patience(500);

/// So many new scenes of one folder are told apart.
constexpr int most_unnamed = 1000;

uint64_t hash_of(const std::string& text) {
  return hash_bytes(text.data(), text.size());
}

std::string time_text(const fs::path& file) {
  std::error_code none;
  const auto written = fs::last_write_time(file, none);
  if (none) return "earlier";
  const auto ago = written - fs::file_time_type::clock::now();
  const auto then = std::chrono::system_clock::now() +
                    std::chrono::duration_cast<std::chrono::system_clock::duration>(ago);
  return fmt::format("{:%Y-%m-%d %H:%M}",
                     fmt::localtime(std::chrono::system_clock::to_time_t(then)));
}

}  // namespace

fs::path unsaved_folder() {
  const fs::path folder = user_folder("XDG_STATE_HOME", ".local/state");
  return folder.empty() ? folder : folder / "tumble/unsaved";
}

fs::path unnamed_scene(int n) {
  std::error_code none;
  const fs::path here = fs::current_path(none);
  return here / (n == 1 ? std::string("untitled.json") : fmt::format("untitled_{}.json", n));
}

void UnsavedWork::open(const SceneFile& file) {
  *this = UnsavedWork(folder_);
  file_ = file;
  text_ = file.text;
  any_ = file.text != file.on_disk;
  choose_file();
}

void UnsavedWork::choose_file() {
  if (folder_.empty() || file_.text.empty()) return;
  keep_in_ = kept_file_of(file_.path);
}

fs::path UnsavedWork::kept_file_of(const fs::path& scene) const {
  return folder_ / fmt::format("{}-{:016x}.json", scene.stem().string(), hash_of(scene.string()));
}

std::vector<UnsavedWork::Unnamed> UnsavedWork::kept_unnamed() const {
  std::vector<Unnamed> out;
  if (folder_.empty()) return out;
  std::error_code none;
  for (int n = 1; n <= most_unnamed; ++n) {
    const fs::path scene = unnamed_scene(n), file = kept_file_of(scene);
    if (scene == file_.path || !fs::exists(file, none)) continue;
    // What has a file by now is offered with that.
    if (fs::exists(scene, none)) continue;
    if (auto text = read_file(file)) out.push_back({scene, {*std::move(text), time_text(file)}});
  }
  return out;
}

fs::path UnsavedWork::free_name() const {
  std::error_code none;
  const auto taken = [&](const fs::path& scene) {
    // In a long tick the newest deeds of the scene that is shown are not known yet.
    if (file_.unnamed && scene == file_.path && (any_ || stale_ || collected_.valid())) return true;
    return fs::exists(scene, none) || (!folder_.empty() && fs::exists(kept_file_of(scene), none));
  };
  int n = 1;
  while (n < most_unnamed && taken(unnamed_scene(n))) ++n;
  return unnamed_scene(n);
}

std::optional<UnsavedWork::Kept> UnsavedWork::kept() const {
  if (keep_in_.empty()) return std::nullopt;
  auto text = read_file(keep_in_);
  if (!text || *text == file_.on_disk || *text == file_.text) return std::nullopt;
  return Kept{*std::move(text), time_text(keep_in_)};
}

void UnsavedWork::update(Session& session, const std::vector<DeedEdits>& deeds, double dt) {
  since_ += dt;
  if (collected_.valid()) {
    if (collected_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
      take(collected_.get());
    return;
  }
  if (!stale_ || file_.text.empty() || since_ < seconds_between_looks) return;
  stale_ = false;
  since_ = 0;
  collected_ = collect_edits(session, deeds);
}

void UnsavedWork::finish(Session& session, const std::vector<DeedEdits>& deeds, bool own_thread) {
  if (file_.text.empty() || (!stale_ && !collected_.valid())) return;
  // What was asked for before the newest deed does not know it.
  if (stale_ || !collected_.valid()) collected_ = collect_edits(session, deeds);
  stale_ = false;
  if (!own_thread) (void)session.advance(0);
  if (collected_.wait_for(patience) == std::future_status::ready) take(collected_.get());
}

std::vector<std::string> UnsavedWork::texts_after(Session& session,
                                                  const std::vector<DeedEdits>& too_old,
                                                  const std::vector<DeedEdits>& deeds,
                                                  bool own_thread) const {
  if (file_.text.empty() || deeds.empty()) return {};
  auto old = collect_edits(session, too_old);
  std::vector<std::future<std::vector<SceneEdit>>> each;
  for (const DeedEdits& deed : deeds) each.push_back(collect_edits(session, {deed}));
  if (!own_thread) (void)session.advance(0);
  if (each.back().wait_for(patience) != std::future_status::ready) return {};
  std::vector<SceneEdit> edits = old.get();
  std::vector<std::string> out;
  std::string text = text_with(edits).value_or(file_.text);
  for (auto& deed : each) {
    for (SceneEdit& edit : deed.get()) edits.push_back(std::move(edit));
    text = text_with(edits).value_or(text);
    out.push_back(text);
  }
  return out;
}

std::optional<std::string> UnsavedWork::text_with(const std::vector<SceneEdit>& edits) const {
  // It is read again in place of the text that it was made of.
  const bool in_place = file_.read_from.parent_path() == file_.path.parent_path();
  auto saved = save_edits(file_.text, in_place ? file_.path.string() : std::string(), edits);
  return saved ? std::optional(std::move(saved->text)) : std::nullopt;
}

void UnsavedWork::take(std::vector<SceneEdit> edits) {
  edits_ = std::move(edits);
  const std::optional<std::string> saved = text_with(edits_);
  if (!saved) {  // what could be kept last stays kept
    any_ = any_ || !edits_.empty();
    return;
  }
  const std::string& now = *saved;
  any_ = now != file_.on_disk;
  if (now == text_) return;
  text_ = now;
  if (keep_in_.empty()) return;
  std::error_code none;
  if (!any_) {
    fs::remove(keep_in_, none);
    return;
  }
  fs::create_directories(folder_, none);
  // A full disk must not stop the work; saving will say what is wrong.
  (void)write_file(keep_in_, std::string_view(text_));
}

void UnsavedWork::saved(const SceneFile& file) {
  throw_away();
  file_.path = file_.read_from = file.path;
  file_.on_disk = file.on_disk;
  choose_file();
  any_ = false;
  stale_ = true;  // the newest deed may have gone on
}

void UnsavedWork::throw_away() {
  std::error_code none;
  if (!keep_in_.empty()) fs::remove(keep_in_, none);
}

}  // namespace tumble
