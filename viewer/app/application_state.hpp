#pragma once
#include "viewer/app/application.hpp"

#include <mutex>

namespace tumble {

// What the application shares with jobs that run on the simulation thread.

/// The world's settings as last fetched.
struct Application::SharedSettings {
  std::mutex mutex;
  WorldSettings value;
};

/// The force of the mouse; touched by jobs only, which run in order.
struct Application::HeldForce {
  ForceId id;
};

}  // namespace tumble
