#include "viewer/app/editing/edit_history.hpp"

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

constexpr size_t most_undo_steps = 200;
/// Memory for the moments of all undo steps [bytes]; the newest undo step is kept whatever its
/// size.
constexpr size_t most_bytes = size_t{256} << 20;

}  // namespace

UndoStepEdits EditHistory::begin(Session& session, std::string what, uint64_t tick,
                                 std::vector<BodyId> selected) {
  undone_.clear();
  auto edits = std::make_shared<std::vector<SceneEdit>>();
  done_.push_back({std::move(what), tick, edits, session.keep(), std::move(selected), course_});
  drop_oldest();
  return edits;
}

void EditHistory::note_beside(std::string what, std::function<void()> exchange) {
  undone_.clear();
  done_.push_back({std::move(what), 0, nullptr, nullptr, {}, course_, std::move(exchange)});
  drop_oldest();
}

std::optional<EditHistory::Back> EditHistory::go(Session& session, std::deque<UndoStep>& from,
                                                 std::deque<UndoStep>& to,
                                                 std::vector<BodyId> selected) {
  if (from.empty()) return std::nullopt;
  UndoStep undo_step = std::move(from.back());
  from.pop_back();
  if (undo_step.exchange) {
    undo_step.exchange();
    to.push_back(undo_step);
    return Back{std::move(undo_step.what), {}, true};
  }
  to.push_back({undo_step.what, undo_step.tick, undo_step.edits, session.keep(),
                std::move(selected), course_});
  course_ = undo_step.course;
  session.restore(std::move(undo_step.moment));
  return Back{std::move(undo_step.what), std::move(undo_step.selected)};
}

std::optional<EditHistory::Back> EditHistory::undo(Session& session, std::vector<BodyId> selected) {
  return go(session, done_, undone_, std::move(selected));
}

void EditHistory::leave_newest(Session& session) {
  if (undo(session, {})) undone_.pop_back();
}

std::optional<EditHistory::Back> EditHistory::redo(Session& session, std::vector<BodyId> selected) {
  return go(session, undone_, done_, std::move(selected));
}

std::vector<UndoStepEdits> EditHistory::file_edits() const {
  std::vector<UndoStepEdits> out = forgotten_;
  for (const UndoStep& undo_step : done_)
    if (undo_step.edits) out.push_back(undo_step.edits);
  return out;
}

std::vector<std::pair<std::string, UndoStepEdits>> EditHistory::undo_steps() const {
  std::vector<std::pair<std::string, UndoStepEdits>> out;
  for (const UndoStep& undo_step : done_)
    if (undo_step.edits) out.emplace_back(undo_step.what, undo_step.edits);
  return out;
}

UndoStepEdits EditHistory::newest() const {
  return std::find_if(done_.rbegin(), done_.rend(),
                      [](const UndoStep& d) { return d.edits != nullptr; })
      ->edits;
}

bool EditHistory::empty() const {
  return std::ranges::none_of(done_, [](const UndoStep& d) { return d.edits != nullptr; });
}

std::vector<uint64_t> EditHistory::ticks() const {
  std::vector<uint64_t> out;
  for (const UndoStep& undo_step : done_)
    if (undo_step.edits) out.push_back(undo_step.tick);
  return out;
}

std::vector<uint64_t> EditHistory::ticks_of_this_course() const {
  std::vector<uint64_t> out;
  for (const UndoStep& undo_step : done_)
    if (undo_step.edits && undo_step.course == course_) out.push_back(undo_step.tick);
  return out;
}

void EditHistory::drop_oldest() {
  size_t bytes = 0;
  const auto bytes_of = [](const UndoStep& undo_step) {
    return undo_step.moment ? Session::bytes(*undo_step.moment) : 0;
  };
  for (const UndoStep& undo_step : done_) bytes += bytes_of(undo_step);
  while (done_.size() > 1 && (done_.size() > most_undo_steps || bytes > most_bytes)) {
    bytes -= bytes_of(done_.front());
    if (done_.front().edits) forgotten_.push_back(done_.front().edits);
    done_.pop_front();
  }
}

}  // namespace tumble
