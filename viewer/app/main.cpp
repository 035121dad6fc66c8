#include "viewer/app/command.hpp"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <vector>

namespace {

/// Ends the program for an exception that cannot reach main: one thrown in another thread, or in a
/// parallel loop.
[[noreturn]] void end_without_catch() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    std::_Exit(tumble::report_no_memory());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "tumble: %s\n", e.what());
  } catch (...) {
  }
  std::abort();
}

}  // namespace

int main(int argc, char** argv) {
  // A file beyond `ulimit -f` becomes a reported error (exit code 5) instead of ending the program
  // by a signal.
  std::signal(SIGXFSZ, SIG_IGN);
  std::set_terminate(end_without_catch);
  try {
    const std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
    return tumble::run_command_line(arguments);
  } catch (const std::bad_alloc&) {
    return tumble::report_no_memory();
  } catch (const std::exception& e) {  // from a library
    std::fprintf(stderr, "tumble: %s\n", e.what());
    return tumble::exit_broken_down;
  }
}
