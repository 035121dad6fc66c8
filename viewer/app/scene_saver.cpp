#include "viewer/app/scene_saver.hpp"

#include "engine/world/world.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <algorithm>
#include <iterator>

namespace tumble {

std::future<std::vector<SceneEdit>> collect_edits(Session& session, std::vector<DeedEdits> deeds) {
  return session.call([deeds = std::move(deeds)](World&) {
    std::vector<SceneEdit> all;
    for (const DeedEdits& deed : deeds) all.insert(all.end(), deed->begin(), deed->end());
    return all;
  });
}

void SceneSaver::open(SceneFile file) {
  *this = SceneSaver{};
  file_ = std::move(file);
}

void SceneSaver::prepare(Session& session, std::vector<DeedEdits> deeds,
                         std::vector<SceneEdit> others) {
  preview_.reset();
  others_ = std::move(others);
  collected_ = collect_edits(session, std::move(deeds));
}

void SceneSaver::update() {
  if (!collected_.valid() ||
      collected_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return;
  std::vector<SceneEdit> edits = std::move(others_);
  std::ranges::move(collected_.get(), std::back_inserter(edits));
  SavePreview& preview = preview_.emplace();
  preview.file = file_.path.string();
  if (file_.text.empty()) {
    preview.fault = "There is no scene file behind this: it was made from a mesh or robot file.";
    return;
  }
  auto saved = save_edits(file_.text, preview.file, edits);
  if (!saved) {
    preview.fault = saved.error().text();
    return;
  }
  text_ = std::move(saved->text);
  preview.left_out = std::move(saved->left_out);
  preview.lines = changed_lines(file_.on_disk, text_);
  std::error_code none;
  if (!std::filesystem::exists(file_.path, none)) return;
  const auto now = read_file(file_.path);
  if (!file_.ours)
    preview.warning = "A file of this name is there already: writing replaces it.";
  else if (now && *now != file_.on_disk)
    preview.warning = "The file was changed by somebody else meanwhile: writing replaces that.";
}

Status SceneSaver::write(const std::filesystem::path& path) {
  if (!preview_ || !preview_->fault.empty())
    return Error{ErrorCode::invalid_argument, "there is nothing to write", {}, {}};
  if (const Status done = write_file(path, std::string_view(text_)); !done) return done;
  file_.path = path;
  file_.ours = true;
  file_.on_disk = text_;
  return {};
}

}  // namespace tumble
