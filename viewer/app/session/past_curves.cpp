#include "viewer/app/session/past_curves.hpp"

#include "engine/world/world.hpp"

#include <algorithm>
#include <chrono>

namespace tumble {
namespace {

/// While a user scrubs, every picture jumps; the computation starts after this many pictures
/// without a jump.
constexpr int quiet_pictures = 6;

}  // namespace

Status PastCurves::Job::go() {
  return Session::go(*way, from, stop, [this](const World& world) {
    const auto frame = world.frame();
    for (size_t i = 0; i < quantities.size(); ++i) {
      const auto value = quantities[i].read(*frame);
      if (!value) continue;
      at[i].push_back(frame->time);
      values[i].push_back(float(*value));
    }
    reached = frame->tick;
    return !stop.requested();
  });
}

void PastCurves::begin(Session& session, const Measures& measures) {
  auto job = std::make_unique<Job>();
  for (const Measures::Series& s : measures.series())
    if (s.wants_past) job->quantities.push_back(s.quantity);
  if (job->quantities.empty()) return;
  job->at.resize(job->quantities.size());
  job->values.resize(job->quantities.size());
  job->way = session.way();
  job_ = std::move(job);
}

void PastCurves::update(Session& session, Measures& measures, bool beside) {
  ++quiet_;
  if (!job_ && quiet_ > quiet_pictures) begin(session, measures);
  if (!job_) return;
  if (!job_->outcome.valid()) {
    const auto ticks = Session::ticks_of(*job_->way);
    if (!ticks) return;
    const auto [first, now] = *ticks;
    job_->to = now;
    job_->from = std::max(first, now - std::min<uint64_t>(now, Measures::capacity - 1));
    job_->reached = job_->from;
    job_->outcome = std::async(beside ? std::launch::async : std::launch::deferred,
                               [job = job_.get()] { return job->go(); });
  }
  if (job_->outcome.wait_for(std::chrono::seconds(0)) == std::future_status::timeout) return;
  // The values computed before a tick fails are valid.
  (void)job_->outcome.get();
  for (size_t i = 0; i < job_->quantities.size(); ++i)
    measures.fill(job_->quantities[i].name, job_->at[i], job_->values[i]);
  job_.reset();
}

void PastCurves::note_jump() {
  quiet_ = 0;
  forget();
}

void PastCurves::forget() {
  if (!job_) return;
  job_->stop.request();
  job_.reset();  // waits for the tick under way to be cancelled
}

std::optional<double> PastCurves::share() const {
  if (!job_) return std::nullopt;
  if (!(job_->to > job_->from)) return 0;
  return double(job_->reached - job_->from) / double(job_->to - job_->from);
}

}  // namespace tumble
