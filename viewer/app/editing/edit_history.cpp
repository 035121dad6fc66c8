#include "viewer/app/editing/edit_history.hpp"

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

constexpr size_t most_deeds = 200;
/// Memory for the moments of all deeds [bytes]; the newest deed is kept whatever its size.
constexpr size_t most_bytes = size_t{256} << 20;

}  // namespace

DeedEdits EditHistory::begin(Session& session, std::string what, uint64_t tick,
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

std::optional<EditHistory::Back> EditHistory::go(Session& session, std::deque<Deed>& from,
                                                 std::deque<Deed>& to,
                                                 std::vector<BodyId> selected) {
  if (from.empty()) return std::nullopt;
  Deed deed = std::move(from.back());
  from.pop_back();
  if (deed.exchange) {
    deed.exchange();
    to.push_back(deed);
    return Back{std::move(deed.what), {}, true};
  }
  to.push_back({deed.what, deed.tick, deed.edits, session.keep(), std::move(selected), course_});
  course_ = deed.course;
  session.restore(std::move(deed.moment));
  return Back{std::move(deed.what), std::move(deed.selected)};
}

std::optional<EditHistory::Back> EditHistory::undo(Session& session, std::vector<BodyId> selected) {
  return go(session, done_, undone_, std::move(selected));
}

std::optional<EditHistory::Back> EditHistory::redo(Session& session, std::vector<BodyId> selected) {
  return go(session, undone_, done_, std::move(selected));
}

std::vector<DeedEdits> EditHistory::file_edits() const {
  std::vector<DeedEdits> out = forgotten_;
  for (const Deed& deed : done_)
    if (deed.edits) out.push_back(deed.edits);
  return out;
}

std::vector<std::pair<std::string, DeedEdits>> EditHistory::deeds() const {
  std::vector<std::pair<std::string, DeedEdits>> out;
  for (const Deed& deed : done_)
    if (deed.edits) out.emplace_back(deed.what, deed.edits);
  return out;
}

DeedEdits EditHistory::newest() const {
  return std::find_if(done_.rbegin(), done_.rend(),
                      [](const Deed& d) { return d.edits != nullptr; })
      ->edits;
}

bool EditHistory::empty() const {
  return std::ranges::none_of(done_, [](const Deed& d) { return d.edits != nullptr; });
}

std::vector<uint64_t> EditHistory::ticks() const {
  std::vector<uint64_t> out;
  for (const Deed& deed : done_)
    if (deed.edits) out.push_back(deed.tick);
  return out;
}

std::vector<uint64_t> EditHistory::ticks_of_this_course() const {
  std::vector<uint64_t> out;
  for (const Deed& deed : done_)
    if (deed.edits && deed.course == course_) out.push_back(deed.tick);
  return out;
}

void EditHistory::drop_oldest() {
  size_t bytes = 0;
  const auto bytes_of = [](const Deed& deed) {
    return deed.moment ? Session::bytes(*deed.moment) : 0;
  };
  for (const Deed& deed : done_) bytes += bytes_of(deed);
  while (done_.size() > 1 && (done_.size() > most_deeds || bytes > most_bytes)) {
    bytes -= bytes_of(done_.front());
    if (done_.front().edits) forgotten_.push_back(done_.front().edits);
    done_.pop_front();
  }
}

}  // namespace tumble
