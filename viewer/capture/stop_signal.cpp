#include "viewer/capture/stop_signal.hpp"

#include <csignal>

namespace tumble {
namespace {

volatile std::sig_atomic_t received = 0;
StopFlag stop_of_signals;
struct sigaction earlier_int, earlier_term;

extern "C" void note_signal(int signal) {
  received = signal;
  stop_of_signals.request();
}

}  // namespace

StopSignal::StopSignal() {
  received = 0;
  stop_of_signals.clear();
  struct sigaction action = {};
  action.sa_handler = note_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = int(SA_RESETHAND | SA_RESTART);
  sigaction(SIGINT, &action, &earlier_int);
  sigaction(SIGTERM, &action, &earlier_term);
}

StopSignal::~StopSignal() {
  sigaction(SIGINT, &earlier_int, nullptr);
  sigaction(SIGTERM, &earlier_term, nullptr);
}

bool StopSignal::requested() const {
  return received != 0;
}

const StopFlag& StopSignal::flag() const {
  return stop_of_signals;
}

int StopSignal::exit_code() const {
  return received == 0 ? 0 : 128 + int(received);
}

}  // namespace tumble
