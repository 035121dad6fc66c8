#include "viewer/context/doctor.hpp"

#include "viewer/app/command.hpp"
#include "viewer/app/options.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

void print_json(const std::vector<DoctorEntry>& entries, bool usable) {
  nlohmann::ordered_json out;
  out["usable"] = usable;
  out["contexts"] = nlohmann::ordered_json::array();
  for (const DoctorEntry& e : entries) {
    nlohmann::ordered_json one = {{"name", e.name}, {"ok", e.ok}};
    if (!e.detail.empty()) one["detail"] = e.detail;
    if (e.ok) {
      one["renderer"] = e.renderer;
      one["version"] = e.version;
      one["software"] = e.software;
    } else {
      one["cause"] = e.cause;
      one["cure"] = e.cure;
    }
    out["contexts"].push_back(std::move(one));
  }
  fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

CommandAction declare_doctor(Options& options) {
  auto json = std::make_shared<bool>(false);
  options.flag("--json", *json, "one JSON object on stdout");
  options.footer(
      "Tries the window, every EGL device, EGL surfaceless and OSMesa; each must make a context,\n"
      "draw a triangle and read it back. 0 when at least one works, else 4.");
  return [json]() -> int {
    const std::vector<DoctorEntry> entries = run_doctor();
    const bool usable =
        std::any_of(entries.begin(), entries.end(), [](const DoctorEntry& e) { return e.ok; });
    if (*json)
      print_json(entries, usable);
    else
      fmt::print("{}", doctor_text(entries));
    return usable ? exit_ok : exit_no_renderer;
  };
}

}  // namespace tumble
