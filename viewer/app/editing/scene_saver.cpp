#include "viewer/app/editing/scene_saver.hpp"

#include "engine/scene/pack/pack.hpp"
#include "engine/scene/saving/changed_lines.hpp"
#include "engine/scene/saving/json_text_edit.hpp"
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

namespace tumble {
namespace fs = std::filesystem;
namespace {

/// Canonical folder of a file, however the path is written.
fs::path folder_of(const fs::path& file) {
  std::error_code none;
  return fs::absolute(file, none).lexically_normal().parent_path();
}

/// Whether a scene refers to files, which are found relative to its folder.
bool names_files(const std::string& scene) {
  const JsonTextEdit text(scene);
  using Path = JsonTextEdit::Path;
  return text.value(Path{} / "meshes") || text.value(Path{} / "robots");
}

}  // namespace

std::future<std::vector<SceneEdit>> collect_edits(Session& session,
                                                  std::vector<UndoStepEdits> undo_steps) {
  return session.call([undo_steps = std::move(undo_steps)](World&) {
    std::vector<SceneEdit> all;
    for (const UndoStepEdits& undo_step : undo_steps)
      all.insert(all.end(), undo_step->begin(), undo_step->end());
    return all;
  });
}

void SceneSaver::open(SceneFile file) {
  *this = SceneSaver{};
  file_ = std::move(file);
}

void SceneSaver::prepare(Session& session, std::vector<UndoStepEdits> undo_steps,
                         std::vector<SceneEdit> others, bool beside) {
  preview_.reset();
  tried_.reset();
  trial_.reset();
  beside_ = beside;
  others_ = std::move(others);
  collected_ = collect_edits(session, std::move(undo_steps));
}

void SceneSaver::update() {
  using std::chrono::seconds;
  if (collected_.valid() && collected_.wait_for(seconds(0)) == std::future_status::ready)
    take_edits(collected_.get());
  if (tried_) look_at_trial();
}

void SceneSaver::take_edits(std::vector<SceneEdit> made) {
  std::vector<SceneEdit> edits = std::move(others_);
  std::ranges::move(made, std::back_inserter(edits));
  edits_ = edits;
  SavePreview preview;
  preview.file = file_.path.string();
  if (file_.text.empty()) {
    preview.fault = "There is no scene file behind this: it was made from a mesh or robot file.";
    preview_ = std::move(preview);
    return;
  }
  auto saved = save_edits(file_.text, preview.file, edits);
  if (!saved) {
    preview.fault = saved.error().text();
    preview_ = std::move(preview);
    return;
  }
  text_ = std::move(saved->text);
  preview.left_out = std::move(saved->left_out);
  preview.lines = changed_lines(file_.on_disk, text_);
  preview.warning = warning_of(file_.path);
  tried_ = std::move(preview);
  // An unchanged scene is known to open from this place.
  const fs::path place = place_of(file_.path);
  if (text_ == file_.on_disk && folder_of(place) == folder_of(file_.read_from)) return;
  trial_ = std::make_unique<OpeningTrial>(text_, place, beside_);
}

/// What may be unexpected about writing to a path; "": nothing.
std::string SceneSaver::warning_of(const fs::path& path) const {
  if (!file_.pack.empty())
    return "It came in a pack: another name that ends in .json writes the scene with its files "
           "beside it, any other a pack.";
  std::error_code none;
  if (!fs::is_regular_file(path, none)) return {};
  if (!file_.ours || !fs::equivalent(path, file_.path, none))
    return "A file of this name is there already: writing replaces it.";
  const auto now = read_file(path);
  if (now && *now != file_.on_disk)
    return "The file was changed by somebody else meanwhile: writing replaces that.";
  return {};
}

void SceneSaver::name(const std::string& file) {
  if (!preview_ || file == named_) return;
  named_ = file;
  std::error_code none;
  preview_->warning = file.empty() ? std::string() : warning_of(fs::absolute(file, none));
}

/// The path at which the scene is test-opened: the path itself, or for a scene from a pack the file
/// that was unpacked.
fs::path SceneSaver::place_of(const fs::path& path) const {
  return file_.pack.empty() ? path : file_.read_from;
}

void SceneSaver::look_at_trial() {
  if (trial_) {
    const auto opens = trial_->take();
    if (!opens) return;
    if (!*opens) {
      tried_->fault = "It would not open again, as it is now:\n" + opens->error().text();
      // Files that it names may be found from another folder.
      tried_->only_there = file_.pack.empty() && names_files(text_);
    }
    trial_.reset();
  }
  preview_ = std::exchange(tried_, std::nullopt);
  named_ = preview_->file;
}

/// Whether the path leads to the scene's own pack, whatever its ending and however it is written.
bool SceneSaver::writes_pack(const fs::path& path) const {
  std::error_code none;
  return path.extension() != ".json" || path == file_.pack ||
         fs::equivalent(path, file_.pack, none);
}

/// A scene from a pack needs the files that came with it: it is written as a pack again, or as a
/// scene file with all these files beside it. The replay of the pack is left out, since it belongs
/// to the original scene.
Status SceneSaver::write_packed(const fs::path& path) const {
  auto files = read_pack(file_.pack);
  if (!files) return files.error();
  std::erase_if(*files, [](const PackFile& f) { return f.name == pack_replay_name; });
  const std::string scene = file_.read_from.filename().string();
  bool known = false;
  for (PackFile& f : *files) {
    if (f.name != scene) continue;
    known = f.bytes == file_.on_disk;
    f.bytes = text_;
  }
  if (!known)
    return Error{ErrorCode::io, "the pack was changed by somebody else since it was opened",
                 file_.pack.string(), "move it elsewhere and save to another name"};
  if (writes_pack(path)) return write_pack(path, *files);
  const auto folder = path.parent_path();
  if (!folder.empty())
    if (Status made = make_folder(folder); !made) return made;
  for (const PackFile& f : *files) {
    if (f.name == scene) continue;
    const auto there = read_file(folder / f.name);
    if (there && *there != f.bytes)
      return Error{ErrorCode::io,
                   "another file of this name is there, which the scene does not mean",
                   (folder / f.name).string(), "save into a folder of its own, or as a pack"};
  }
  for (const PackFile& f : *files) {
    if (f.name == scene) continue;
    const auto to = folder / f.name;
    if (Status made = make_folder(to.parent_path()); !made) return made;
    if (Status done = write_file(to, std::string_view(f.bytes)); !done) return done;
  }
  return write_file(path, std::string_view(text_));
}

Status SceneSaver::write(const fs::path& to) {
  if (!preview_) return Error{ErrorCode::invalid_argument, "there is nothing to write", {}, {}};
  std::error_code none;
  const fs::path path = fs::absolute(to, none).lexically_normal();
  // Files that a scene refers to are found relative to its own folder.
  const bool elsewhere = file_.pack.empty() && folder_of(path) != folder_of(file_.path);
  if (!preview_->fault.empty() && !(preview_->only_there && elsewhere))
    return Error{ErrorCode::invalid_argument, preview_->fault, {}, {}};
  std::string text = text_;
  if (elsewhere) {
    auto moved = save_edits(file_.text, path.string(), edits_);
    if (!moved) return moved.error();
    if (Status opens = check_scene_text(moved->text, path); !opens) {
      Error error = opens.error();
      error.message = "as " + path.string() + " it would not open again: " + error.message;
      return error;
    }
    text = std::move(moved->text);
  }
  const Status done =
      file_.pack.empty() ? write_file(path, std::string_view(text)) : write_packed(path);
  if (!done) return done;  // as if nothing had been tried, so that another name can be
  text_ = std::move(text);
  if (!file_.pack.empty()) {
    const bool pack = writes_pack(path);
    file_.pack = pack ? path : fs::path();
  }
  if (file_.pack.empty()) file_.read_from = path;
  file_.path = path;
  file_.ours = true;
  file_.unnamed = false;
  file_.on_disk = text_;
  return {};
}

}  // namespace tumble
