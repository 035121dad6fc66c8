#include "viewer/app/simulate/state_export.hpp"

#include "engine/core/hash.hpp"
#include "engine/world/shown_state.hpp"
#include "engine/world/world.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <algorithm>
#include <iterator>
#include <span>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Existing states of earlier runs and their list, sorted by name.
std::vector<std::filesystem::path> state_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> out;
  std::error_code code;
  for (std::filesystem::directory_iterator it(folder, code), end; !code && it != end;
       it.increment(code))
    if (const std::string name = it->path().filename().string();
        name == state_list_name || is_state_file_name(name))
      out.push_back(it->path());
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

Result<StateExport> StateExport::begin(const StateExportOptions& options) {
  StateExport out;
  out.options_ = options;
  if (!out.wanted()) return out;
  out.list_ = options.list;
  const std::string run = fmt::format("{}|{}|{}/{}|{}", options.list.run, options.list.start,
                                      out.list_.fps.num, out.list_.fps.den, out.list_.every_tick);
  out.list_.run = hash_text(hash_bytes(run.data(), run.size()));
  if (Status made = out.make_room(); !made) return made.error();
  return out;
}

Status StateExport::make_room() {
  const auto& folder = options_.folder;
  if (Status made = make_folder(folder); !made) return made;
  auto lock = FolderLock::take(folder);
  if (!lock) return lock.error();
  lock_.emplace(*std::move(lock));
  const auto files = state_files(folder);
  if (!files.empty() && !options_.resume && !options_.force)
    return Error{ErrorCode::io, "there are states already", files.front().string(),
                 "--resume goes on with them, --force overwrites them"};
  if (!files.empty() && options_.resume && !options_.force) {
    auto earlier = read_state_list(folder);
    if (!earlier)
      return Error{ErrorCode::io, "cannot go on: " + earlier.error().message, earlier.error().place,
                   "choose another folder, or --force, which overwrites the files there"};
    if (earlier->run != list_.run)
      return Error{ErrorCode::io, "these are states of another run (scene, settings or rate)",
                   files.front().string(), "choose another folder, or --force"};
    kept_ = whole_states(folder, *earlier);
    list_.states = std::move(earlier->states);
    list_.states.resize(kept_);
    std::erase_if(list_.states,
                  [this](const SavedState& s) { return s.tick > options_.last_tick; });
    kept_ = list_.states.size();
  }
  remove_temporary_files(folder);
  std::error_code code;
  for (const auto& file : files) {
    const std::string name = file.filename().string();
    const bool kept = std::ranges::any_of(
        list_.states, [&](const SavedState& s) { return state_file_name(s.tick) == name; });
    if (name != state_list_name && !kept) std::filesystem::remove(file, code);
  }
  return save_list();  // first, so that an unwritable folder is detected before simulating
}

Status StateExport::skip(World& world) {
  const auto later =
      std::ranges::lower_bound(list_.states, options_.last_tick, {}, &SavedState::tick);
  if (later == list_.states.begin()) return {};
  const auto content = read_state(options_.folder, *std::prev(later));
  if (!content) return content.error();
  return world.load(snapshot_of(std::as_bytes(std::span(*content))));
}

bool StateExport::is_due(uint64_t tick) {
  const auto at = [&] { return frame_time(frame_, list_.fps, list_.rate); };
  while (frame_ < list_.frames_wanted && at().last_tick() < tick) ++frame_;
  return list_.every_tick || (frame_ < list_.frames_wanted && at().tick <= tick);
}

Status StateExport::add(const World& world) {
  if (!wanted() || !status_ || !is_due(world.tick())) return status_;
  const bool there = kept_ > 0 && world.tick() <= list_.states[kept_ - 1].tick;
  status_ = there ? check_kept(world) : write(world);
  return status_;
}

Status StateExport::check_kept(const World& world) const {
  const SavedState* state = list_.find(world.tick());
  if (state && state->state_hash == world.state_hash()) return {};
  return Error{
      ErrorCode::internal,
      fmt::format("the state at tick {} is not the one of the interrupted run", world.tick()),
      (options_.folder / state_list_name).string(),
      "the scene, its assets or the program changed: use --force"};
}

Status StateExport::write(const World& world) {
  const Bytes bytes = save_shown(world, options_.geometry);
  if (Status written =
          write_file(options_.folder / state_file_name(world.tick()), std::span(bytes));
      !written)
    return written;
  list_.states.push_back({world.tick(), world.state_hash(), hash_bytes(bytes)});
  // Saved regularly, so that even a run that is killed can be resumed.
  if (std::chrono::steady_clock::now() - list_saved_ > std::chrono::seconds(2)) return save_list();
  return {};
}

Status StateExport::save_list() {
  list_saved_ = std::chrono::steady_clock::now();
  return write_state_list(options_.folder, list_);
}

Status StateExport::commit() {
  if (!wanted()) return {};
  const Status saved = save_list();
  return status_ ? saved : status_;
}

}  // namespace tumble
