#include "viewer/app/editing/unsaved_work.hpp"

#include "engine/core/hash.hpp"
#include "engine/scene/resources.hpp"
#include "engine/scene/saving/merge_texts.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <chrono>
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace tumble {
namespace fs = std::filesystem;
namespace {

/// While a widget is held, changes come with every picture; they are collected at this interval
/// [s].
constexpr double seconds_between_looks = 1;

/// How long to wait for the session; during a slower tick, the answer is skipped.
constexpr std::chrono::milliseconds patience(500);

/// Greatest number of new scenes in one folder.
constexpr int most_unnamed = 1000;

/// Greatest number of files for the unsaved work on one scene: of windows that show it now, and of
/// earlier runs whose work nobody has continued.
constexpr int most_places = 64;

fs::path lock_of(const fs::path& kept) {
  fs::path lock = kept;
  return lock.replace_extension(".lock");
}

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

void UnsavedWork::open(const SceneFile& file, bool goes_on) {
  auto held = std::move(held_);
  const fs::path goes_on_in = taken_.empty() && goes_on ? keep_in_ : taken_;
  *this = UnsavedWork(folder_);
  held_ = std::move(held);
  file_ = file;
  text_ = file.text;
  any_ = opened_changed_ = file.text != file.on_disk;
  if (held_.contains(goes_on_in) && is_of_scene(goes_on_in)) keep_in_ = goes_on_in;
  if (any_ || goes_on) keep();
}

/// Whether a file contains unsaved work on the scene shown.
bool UnsavedWork::is_of_scene(const fs::path& kept) const {
  for (int place = 1; place <= most_places; ++place)
    if (kept == kept_file_of(file_.path, place)) return true;
  return false;
}

/// Chooses and locks a file that no other process uses.
void UnsavedWork::claim_file() {
  std::error_code none;
  for (int place = 1; place <= most_places; ++place) {
    const fs::path file = kept_file_of(file_.path, place);
    auto lock = ProcessLock::take(lock_of(file));
    if (!lock || fs::exists(file, none)) continue;
    held_.insert_or_assign(file, *std::move(lock));
    keep_in_ = file;
    return;
  }
}

fs::path UnsavedWork::kept_file_of(const fs::path& scene, int place) const {
  std::string name = fmt::format("{}-{:016x}", scene.stem().string(), hash_of(scene.string()));
  if (place > 1) name += fmt::format("-{}", place);
  return folder_ / (name + ".json");
}

UnsavedWork::Files UnsavedWork::kept_files_of(const fs::path& scene) const {
  Files out;
  if (folder_.empty()) return out;
  std::error_code none;
  for (int place = 1; place <= most_places; ++place)
    if (fs::path file = kept_file_of(scene, place); fs::exists(file, none))
      out.push_back(std::move(file));
  return out;
}

/// Whether another running program uses this file.
bool UnsavedWork::is_anothers(const fs::path& kept) const {
  return !held_.contains(kept) && !ProcessLock::take(lock_of(kept));
}

std::optional<UnsavedWork::Kept> UnsavedWork::read_kept(const fs::path& kept) const {
  if (is_anothers(kept)) return std::nullopt;
  auto text = read_file(kept);
  if (!text) return std::nullopt;
  std::error_code none;
  const auto scene = fs::last_write_time(file_.path, none);
  const bool older = !none && scene > fs::last_write_time(kept, none);
  return Kept{*std::move(text), time_text(kept), kept, held_.contains(kept), older};
}

std::vector<UnsavedWork::Unnamed> UnsavedWork::kept_unnamed() const {
  std::vector<Unnamed> out;
  std::error_code none;
  if (folder_.empty() || !fs::exists(folder_, none)) return out;
  for (int n = 1; n <= most_unnamed; ++n) {
    const fs::path scene = unnamed_scene(n);
    // A scene that has been saved meanwhile is offered when it is opened.
    if (scene == file_.path || fs::exists(scene, none)) continue;
    for (const fs::path& file : kept_files_of(scene))
      if (auto kept = read_kept(file)) out.push_back({scene, *std::move(kept)});
  }
  return out;
}

void UnsavedWork::take_over(const Kept& kept) {
  taken_ = kept.file;
  if (held_.contains(kept.file)) return;
  if (auto lock = ProcessLock::take(lock_of(kept.file)))
    held_.insert_or_assign(kept.file, *std::move(lock));
}

fs::path UnsavedWork::free_name() const {
  std::error_code none;
  const auto taken = [&](const fs::path& scene) {
    // During a slow tick the newest changes of the scene shown are not known yet.
    if (file_.unnamed && scene == file_.path && (any_ || stale_ || collected_.valid())) return true;
    return fs::exists(scene, none) || !kept_files_of(scene).empty();
  };
  int n = 1;
  while (n < most_unnamed && taken(unnamed_scene(n))) ++n;
  return unnamed_scene(n);
}

std::optional<UnsavedWork::Kept> UnsavedWork::kept() const {
  if (file_.text.empty()) return std::nullopt;
  for (const fs::path& file : kept_files_of(file_.path))
    if (auto kept = read_kept(file);
        kept && kept->text != file_.on_disk && kept->text != file_.text)
      return kept;
  return std::nullopt;
}

void UnsavedWork::expect(std::string text) {
  look_again();
  expected_ = std::move(text);
  expected_asked_ = false;
  keep();  // the session may be busy until the program ends
}

void UnsavedWork::look_again() {
  note();
  expected_.reset();
  hurry();
}

void UnsavedWork::hurry() {
  since_ = seconds_between_looks;
}

void UnsavedWork::update(Session& session, const std::vector<UndoStepEdits>& undo_steps,
                         double dt) {
  since_ += dt;
  if (collected_.valid()) {
    if (collected_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
      take(collected_.get());
    return;
  }
  if (!stale_ || file_.text.empty() || since_ < seconds_between_looks) return;
  since_ = 0;
  ask(session, undo_steps);
}

void UnsavedWork::ask(Session& session, const std::vector<UndoStepEdits>& undo_steps) {
  collected_ = collect_edits(session, undo_steps);
  stale_ = false;
  expected_asked_ = true;
}

void UnsavedWork::finish(Session& session, const std::vector<UndoStepEdits>& undo_steps,
                         bool own_thread) {
  if (known()) return;
  // A query sent before the newest change does not include it.
  if (stale_ || !collected_.valid()) ask(session, undo_steps);
  if (!own_thread) (void)session.advance(0);
  if (collected_.wait_for(patience) == std::future_status::ready) take(collected_.get());
}

std::vector<std::string> UnsavedWork::texts_after(const std::string& start, Session& session,
                                                  const std::vector<UndoStepEdits>& too_old,
                                                  const std::vector<UndoStepEdits>& undo_steps,
                                                  bool own_thread) const {
  if (file_.text.empty() || undo_steps.empty()) return {};
  auto old = collect_edits(session, too_old);
  std::vector<std::future<std::vector<SceneEdit>>> each;
  for (const UndoStepEdits& undo_step : undo_steps)
    each.push_back(collect_edits(session, {undo_step}));
  if (!own_thread) (void)session.advance(0);
  if (each.back().wait_for(patience) != std::future_status::ready) return {};
  std::vector<SceneEdit> edits = old.get();
  std::vector<std::string> out;
  std::string text = text_with(start, edits).value_or(start);
  for (auto& undo_step : each) {
    for (SceneEdit& edit : undo_step.get()) edits.push_back(std::move(edit));
    text = text_with(start, edits).value_or(text);
    out.push_back(text);
  }
  return out;
}

std::optional<std::string> UnsavedWork::text_with(const std::string& text,
                                                  const std::vector<SceneEdit>& edits) const {
  // The kept text is opened in place of the file's text, so relative paths must stay valid.
  const bool in_place = file_.read_from.parent_path() == file_.path.parent_path();
  auto saved = save_edits(text, in_place ? file_.path.string() : std::string(), edits);
  return saved ? std::optional(std::move(saved->text)) : std::nullopt;
}

Result<std::string> UnsavedWork::with(const std::string& theirs) const {
  if (const SceneRead read = read_scene(theirs, file_.path.string()); !read.ok())
    return to_error(read.faults);
  if (!opened_changed_)
    if (auto text = text_with(theirs, edits_)) return *std::move(text);
  if (auto text = merge_texts(file_.on_disk, this->text(), theirs)) return *std::move(text);
  return Error{ErrorCode::invalid_argument, "It has other changes of the same lines", {}, {}};
}

void UnsavedWork::take(std::vector<SceneEdit> edits) {
  // An answer to an earlier question does not have the change that is expected.
  if (expected_asked_) expected_.reset();
  edits_ = std::move(edits);
  const std::optional<std::string> saved = text_with(file_.text, edits_);
  if (!saved) {  // what was kept last stays
    any_ = any_ || !edits_.empty();
    return;
  }
  any_ = *saved != file_.on_disk;
  text_ = *saved;
  keep();
}

/// Writes the unsaved work to its file; removes the file if everything is saved.
void UnsavedWork::keep() {
  if (folder_.empty() || file_.text.empty()) return;
  if (!any()) return throw_away(keep_in_);
  if (text() == kept_text_) return;
  std::error_code none;
  fs::create_directories(folder_, none);
  if (keep_in_.empty()) claim_file();
  // A full disk must not stop the work; saving will report it.
  if (!keep_in_.empty() && write_file(keep_in_, std::string_view(text())).ok()) kept_text_ = text();
}

void UnsavedWork::saved(const SceneFile& file) {
  throw_away(keep_in_);
  file_.path = file_.read_from = file.path;
  file_.on_disk = file.on_disk;
  keep_in_.clear();
  kept_text_.clear();
  any_ = false;
  expected_.reset();
  stale_ = true;  // the newest change may have continued
}

void UnsavedWork::throw_away(const fs::path& kept) {
  if (kept.empty()) return;
  const fs::path file = kept;  // a copy, since `kept` may refer to keep_in_
  if (is_anothers(file)) return;
  std::error_code none;
  fs::remove(file, none);
  held_.erase(file);
  if (keep_in_ != file) return;
  keep_in_.clear();
  kept_text_.clear();
}

}  // namespace tumble
