#include "viewer/app/window/marks_controller.hpp"

#include "viewer/capture/atomic_file.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;
constexpr size_t most_marks_bytes = 16 << 20;

Json json_of(const Vec3& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

Json json_of(const SceneMarks& marks, const TickClock& clock) {
  Json out = Json::object();
  for (const Bookmark& b : marks.time.bookmarks)
    out["bookmarks"].push_back({{"time", clock.time_of(b.tick)}, {"name", b.name}});
  if (const auto& span = marks.time.span)
    out["loop"] = {{"from", clock.time_of(span->from)}, {"to", clock.time_of(span->to)}};
  for (const CameraKey& key : marks.flight) {
    Json one = {{"time", key.time},
                {"position", json_of(key.camera.eye)},
                {"target", json_of(key.camera.target)},
                {"fov_deg", key.camera.fov_deg}};
    if (!key.follow.empty()) {
      one["follow"] = key.follow;
      one["followed_at"] = json_of(key.follow_x);
    }
    out["flight"].push_back(std::move(one));
  }
  return out;
}

/// Throws nlohmann::json's exception if the value has the wrong type.
uint64_t tick_at(const Json& seconds, double tick) {
  const double ticks = seconds.get<double>() / tick;
  if (!(ticks >= 0 && ticks < 1e15)) throw std::runtime_error("a time that no run reaches");
  return uint64_t(std::llround(ticks));
}

Vec3 vector_of(const Json& json) {
  if (json.size() != 3) throw std::runtime_error("a place has three numbers");
  const Vec3 out(json[0].get<double>(), json[1].get<double>(), json[2].get<double>());
  if (!out.allFinite()) throw std::runtime_error("a place has three finite numbers");
  return out;
}

CameraKey key_of(const Json& json, double tick) {
  CameraKey key;
  key.time = json.at("time").get<double>();
  (void)tick_at(json.at("time"), tick);
  key.camera.eye = vector_of(json.at("position"));
  key.camera.target = vector_of(json.at("target"));
  const double ahead = (key.camera.target - key.camera.eye).norm();
  if (!(ahead > 0 && std::isfinite(ahead))) throw std::runtime_error("a camera that looks nowhere");
  key.camera.fov_deg = std::clamp(json.at("fov_deg").get<double>(), 1.0, 170.0);
  if (json.contains("follow")) {
    key.follow = json["follow"].get<std::string>();
    key.follow_x = vector_of(json.at("followed_at"));
  }
  return key;
}

SceneMarks marks_of(const Json& json, double tick) {
  SceneMarks out;
  for (const Json& b : json.value("bookmarks", Json::array())) {
    const uint64_t at = tick_at(b.at("time"), tick);
    if (std::ranges::find(out.time.bookmarks, at, &Bookmark::tick) == out.time.bookmarks.end())
      out.time.toggle(at, b.at("name").get<std::string>());
  }
  if (json.contains("loop")) {
    const TickSpan span{tick_at(json["loop"].at("from"), tick),
                        tick_at(json["loop"].at("to"), tick)};
    if (span.from < span.to) out.time.span = span;
  }
  for (const Json& k : json.value("flight", Json::array())) {
    const CameraKey key = key_of(k, tick);
    if (out.flight.empty() || out.flight.back().time < key.time) out.flight.push_back(key);
  }
  return out;
}

/// "" if there is no file.
Result<std::string> text_of_marks(const fs::path& file) {
  std::error_code none;
  if (file.empty() || !fs::exists(file, none)) return std::string();
  return read_file(file, most_marks_bytes);
}

Error no_marks(const std::exception& e) {
  return {ErrorCode::parse,
          fmt::format("no list of bookmarks: {}", e.what()),
          {},
          "mend the file, or delete it"};
}

Error in_file(Error error, const fs::path& file) {
  if (error.place.empty()) error.place = file.string();
  return error;
}

}  // namespace

Result<SceneMarks> read_marks(std::string_view text, const std::string& scene,
                              double tick_seconds) {
  if (text.empty()) return SceneMarks{};
  try {
    const Json scenes = Json::parse(text).at("scenes");
    return scenes.contains(scene) ? marks_of(scenes[scene], tick_seconds) : SceneMarks{};
  } catch (const std::exception& e) {
    return no_marks(e);
  }
}

Result<std::string> with_marks(std::string_view text, const std::string& scene,
                               const SceneMarks& marks, const TickClock& clock) {
  try {
    Json json = text.empty() ? Json{{"scenes", Json::object()}} : Json::parse(text);
    Json& scenes = json.at("scenes");
    if (const Json of_scene = json_of(marks, clock); of_scene.empty())
      scenes.erase(scene);
    else
      scenes[scene] = of_scene;
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  } catch (const std::exception& e) {
    return no_marks(e);
  }
}

Status MarksController::open(const std::string& scene, double tick_seconds) {
  Status kept = keep(true);
  changed_ = failed_ = false;
  scene_ = scene;
  clock_ = TickClock(tick_seconds);
  marks_ = {};
  jumped_.reset();
  if (file_.empty()) {
    marks_ = others_[scene];
    return kept;
  }
  const auto text = text_of_marks(file_);
  auto marks = text ? read_marks(*text, scene, tick_seconds) : Result<SceneMarks>(text.error());
  readable_ = marks.ok();
  if (!readable_) return in_file(marks.error(), file_);
  marks_ = std::move(*marks);
  return kept;
}

void MarksController::go_on_as(const std::string& scene) {
  if (scene == scene_) return;
  scene_ = scene;
  changed_ = true;
  failed_ = false;
}

void MarksController::change(const std::function<void(SceneMarks&)>& how) {
  how(marks_);
  changed_ = true;
  failed_ = false;
}

Status MarksController::keep(bool once_more) {
  if (!changed_ || (failed_ && !once_more)) return {};
  const Status written = write();
  changed_ = failed_ = !written;
  return written;
}

Status MarksController::write() {
  if (file_.empty()) {
    others_[scene_] = marks_;
    return {};
  }
  if (!readable_) return {};
  // Read anew, since another window may have written its own marks meanwhile.
  const auto text = text_of_marks(file_);
  if (!text) return in_file(text.error(), file_);
  const auto changed = with_marks(*text, scene_, marks_, clock_);
  if (!changed) return in_file(changed.error(), file_);
  if (Status made = make_folder(file_.parent_path()); !made) return made;
  return write_file(file_, std::string_view(*changed));
}

std::optional<uint64_t> MarksController::jump_back(uint64_t tick, uint64_t generation) {
  const TimeMarks& time = marks_.time;
  if (!time.looping || !time.span || tick < time.span->to || jumped_ == generation)
    return std::nullopt;
  jumped_ = generation;
  return time.span->from;
}

}  // namespace tumble
