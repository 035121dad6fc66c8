#include "engine/scene/saving/scene_edits.hpp"

#include "engine/scene/reader.hpp"
#include "engine/scene/saving/file_changes.hpp"

namespace tumble {

std::string name_after(const std::filesystem::path& file) {
  constexpr size_t longest = 56;
  std::string name = file.stem().string().substr(0, longest);
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  for (char& c : name)
    if (!digit(c) && !letter(c)) c = '_';
  return name.empty() || digit(name[0]) ? "_" + name : name;
}

Result<SavedScene> save_edits(const std::string& text, const std::string& file,
                              std::span<const SceneEdit> edits) {
  FileChanges changes{JsonTextEdit(text), {}, {}, std::filesystem::path(file).parent_path()};
  for (const SceneEdit& e : edits) std::visit(changes, e);
  const SceneRead read = read_scene(changes.edit.text(), file);
  if (!read.ok()) return to_error(read.faults);
  return SavedScene{changes.edit.text(), std::move(changes.left_out)};
}

struct FileRemovals::State {
  FileChanges changes;
};

FileRemovals::FileRemovals(const std::string& text, std::span<const SceneEdit> before)
    : state_(std::make_unique<State>(State{{JsonTextEdit(text), {}, {}}})) {
  for (const SceneEdit& e : before) std::visit(state_->changes, e);
}
FileRemovals::~FileRemovals() = default;

std::vector<TakenAlong> FileRemovals::take(const SceneEdit& removal) {
  state_->changes.along.clear();
  std::visit(state_->changes, removal);
  return std::move(state_->changes.along);
}

const std::string& FileRemovals::text() const {
  return state_->changes.edit.text();
}

std::vector<TakenAlong> taken_along(const std::string& text, std::span<const SceneEdit> before,
                                    const SceneEdit& removal) {
  return FileRemovals(text, before).take(removal);
}

}  // namespace tumble
