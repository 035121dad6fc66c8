#include "viewer/app/window/status_file.hpp"

#include "engine/core/hash.hpp"
#include "engine/world/world.hpp"

#include <cerrno>
#include <cstring>

#include <nlohmann/json.hpp>

namespace tumble {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Vec3& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

Json selected_json(Application& app) {
  const Frame& frame = *app.view().to;
  const auto slot = find_slot(frame, app.selected());
  if (!slot) return nullptr;
  return {{"name", frame.info(*slot).name}, {"x", vector_json(frame.body(*slot).pose.x)}};
}

Json points_json(Application& app, double units) {
  constexpr size_t most = 64;
  const Frame& frame = *app.view().to;
  Json points = Json::object();
  for (size_t slot = 0; slot < frame.body_slots() && points.size() < most; ++slot) {
    const BodyInfo& info = frame.info(slot);
    if (frame.body(slot).id.is_null() || info.type != BodyType::dynamic) continue;
    Json entry = {{"x", vector_json(frame.body(slot).pose.x)}};
    if (const auto at = app.locate("body:" + info.name))
      entry["at"] = Json::array({at->x * units, at->y * units});
    points[info.name] = std::move(entry);
  }
  return points;
}

Json settings_json(const WorldSettings& s) {
  return {{"tick_hz", double(s.tick.num) / double(s.tick.den)},
          {"gravity", vector_json(s.gravity.now())},
          {"stepper", s.stepper},
          {"broad_phase", s.broad_phase},
          {"hierarchy", s.hierarchy},
          {"narrow_phase", s.narrow_phase},
          {"contact_time", s.contact_time},
          {"integrator", s.event.integrator},
          {"impulses", s.event.impulses},
          {"substeps", s.realtime.substeps}};
}

Json panels_json(const UiState& state) {
  Json panels = Json::array();
  if (state.hidden) return panels;
  for (const PanelEntry& panel : all_panels())
    if (state.shows(panel.id)) panels.push_back(panel.name);
  return panels;
}

}  // namespace

Result<StatusFile> StatusFile::create(const std::filesystem::path& path) {
  StatusFile out;
  out.file_.reset(std::fopen(path.c_str(), "w"));
  if (!out.file_) return Error{ErrorCode::io, std::strerror(errno), path.string(), {}};
  return out;
}

/// Queries the world's present values; during a slow tick, the last ones are kept.
void StatusFile::ask_world(Session& session) {
  constexpr double slow_tick = 0.5;  // [s]
  constexpr std::chrono::milliseconds patience(20);
  if (!asked_.valid())
    asked_ = session.call([](World& world) { return Known{world.state_hash(), world.settings()}; });
  while (asked_.wait_for(patience) != std::future_status::ready)
    if (session.counters().under_way_seconds > slow_tick) return;
  known_ = asked_.get();
}

void StatusFile::add(Application& app, double units) {
  const SessionCounters counters = app.session().counters();
  const Frame& frame = *app.view().to;
  Json line;
  line["picture"] = pictures_++;
  line["tick"] = frame.tick;
  line["time"] = frame.time;
  line["paused"] = counters.paused;
  line["speed"] = counters.speed;
  line["scene"] = app.scene_name();
  line["bodies"] = frame.stats.bodies;
  line["selected"] = selected_json(app);
  line["dragging"] = app.dragging();
  line["full_screen"] = app.full_screen();
  line["recording"] = app.recording();
  line["eye"] = vector_json(app.camera().camera().eye);
  line["pivot"] = vector_json(app.camera().pivot());
  ask_world(app.session());
  line["state_hash"] = hash_text(known_.hash);
  line["settings"] = settings_json(known_.settings);
  line["under_way"] = counters.under_way_seconds;
  line["threads"] = app.threads();
  line["overlays"] = Json::array();
  for (const OverlayEntry& overlay : all_overlays())
    if (app.ui_state().overlays.*overlay.enabled) line["overlays"].push_back(overlay.name);
  line["panels"] = panels_json(app.ui_state());
  line["toasts"] = Json::array();
  for (const Toast& toast : app.ui_state().toasts) line["toasts"].push_back(toast.title);
  line["widgets"] = Json::object();
  for (const auto& [name, r] : app.ui().widgets())
    line["widgets"][name] =
        Json::array({double(r.x + 0.5f * r.width) * units, double(r.y + 0.5f * r.height) * units});
  line["points"] = points_json(app, units);
  line["turn"] = Json::object();
  for (size_t slot = 0; slot < frame.body_slots(); ++slot)
    if (frame.info(slot).type == BodyType::dynamic && line["turn"].size() < 64)
      line["turn"][frame.info(slot).name] = std::abs(frame.body(slot).pose.q.w());
  line["captured"] = Json::array();
  for (const auto& path : app.captured()) line["captured"].push_back(path.string());
  const std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  std::fwrite(text.data(), 1, text.size(), file_.get());
  std::fflush(file_.get());
}

}  // namespace tumble
