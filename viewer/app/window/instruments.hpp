#pragma once
#include "viewer/app/session/contact_probe.hpp"
#include "viewer/app/session/event_watch.hpp"
#include "viewer/app/session/microscope_probe.hpp"
#include "viewer/app/session/past_curves.hpp"
#include "viewer/app/window/microscope_controller.hpp"
#include "viewer/app/window/ruler.hpp"
#include "viewer/ui/history.hpp"
#include "viewer/ui/measures.hpp"

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace tumble {

/// The instruments with which a run is observed.
struct Instruments {
  History history;
  Measures measures;
  PastCurves past;  ///< computes the past of plotted curves
  Ruler ruler;
  std::shared_ptr<EventWatch> events;  ///< events of the world shown
  std::future<Session::Search> jump;   ///< the search for the next event
  std::string jump_words;              ///< what was said of the last one
  ContactProbe probe;
  MicroscopeController microscope;
  MicroscopeProbe microscope_probe;

  /// To be called when another world is shown.
  void open(std::optional<MicroscopeSetup> of_scene) {
    history.clear();
    measures.clear();
    past.forget();
    ruler.forget();
    events = std::make_shared<EventWatch>();
    jump = {};
    probe.clear();
    microscope.open(std::move(of_scene));
    microscope_probe.clear();
  }
};

}  // namespace tumble
