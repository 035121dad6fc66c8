#include "viewer/app/session/replay_saver.hpp"

#include "engine/world/replay.hpp"
#include "engine/world/world.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/free_name.hpp"

#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tumble {
namespace {

bool is_there(const auto& future) {
  return future.valid() && future.wait_for(std::chrono::seconds(0)) != std::future_status::timeout;
}

/// The scene's text with the chosen parameter values.
Result<SceneRequest> as_file(const ReplaySaver::Beginning& beginning) {
  SceneRequest request = beginning.scene;
  if (request.overrides.size() != beginning.numbers.size())
    return Error{ErrorCode::invalid_argument,
                 fmt::format("the scene was opened with values that its file does not have: {}",
                             fmt::join(request.overrides, ", ")),
                 {},
                 "write them into the file, and open that; or save the replay alone"};
  request.overrides.clear();
  if (beginning.numbers.empty()) return request;
  if (!request.text)
    return Error{ErrorCode::invalid_argument, "the scene has no file that could hold its numbers",
                 request.scene, "save the replay alone"};
  auto changed = save_edits(*request.text, "", beginning.numbers);
  if (!changed) return changed.error();
  request.text = std::move(changed->text);
  return request;
}

}  // namespace

void ReplaySaver::save(Session& session, Request request) {
  request_ = std::move(request);
  of_job_ = beginning_;
  said_ = session.call([](World& world) {
    return Said{save_replay(world), world.tick(), world.time()};
  });
}

void ReplaySaver::begin_job() {
  job_ = std::async(request_.beside ? std::launch::async : std::launch::deferred,
                    [stop = &stop_, request = request_, beginning = of_job_, said = said_.get()] {
                      const Stoppable scope(stop);
                      return write(request, beginning, said);
                    });
}

Result<ReplaySaver::Saved> ReplaySaver::write(const Request& request, const Beginning& beginning,
                                              const Said& said) {
  if (Status made = make_folder(request.folder); !made) return made.error();
  const std::string stem =
      fmt::format("tumble-{}-replay", request.name.empty() ? "scene" : request.name);
  Saved saved{free_name(request.folder, stem, request.packed ? ".tumble" : ".bin"),
              said.ticks,
              said.seconds,
              {}};
  if (!request.packed) {
    saved.needs = beginning.scene.overrides;
    if (Status done = write_file(saved.file, said.replay); !done) return done.error();
    return saved;
  }
  const auto request = as_file(beginning);
  if (!request) return request.error();
  const NamedReplay replay{
      std::string(reinterpret_cast<const char*>(said.replay.data()), said.replay.size()), {}};
  const auto files = packed_scene(*request, &replay);
  if (!files) return files.error();
  if (Status done = write_pack(saved.file, *files); !done) return done.error();
  return saved;
}

std::optional<Result<ReplaySaver::Saved>> ReplaySaver::take() {
  if (is_there(said_)) begin_job();
  if (!is_there(job_)) return std::nullopt;
  return job_.get();
}

void ReplaySaver::finish(Session& session) {
  if (!busy()) return;
  if (said_.valid()) {
    if (!request_.beside) (void)session.advance(0);
    said_.wait();
    begin_job();
  }
  if (request_.packed) stop_.request();
  (void)job_.get();
  stop_.clear();
}

}  // namespace tumble
