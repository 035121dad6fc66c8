#pragma once
#include <functional>
#include <string>

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tumble {

/// What became of a function that ran in a process of its own.
struct ChildOutcome {
  bool crashed = false;  ///< ended by a signal other than the alarm
  bool timed_out = false;
  std::string text;  ///< what the function returned, up to the pipe's capacity
};

/// Runs `work` in a forked child with at most `seconds` of time, so that a crash or an endless loop
/// of a library is seen and not suffered.
inline ChildOutcome run_in_child(const std::function<std::string()>& work, unsigned seconds) {
  int ends[2];
  if (pipe(ends) != 0) return {true, false, "no pipe"};
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    signal(SIGALRM, SIG_DFL);
    signal(SIGABRT, SIG_DFL);
    signal(SIGSEGV, SIG_DFL);
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    alarm(seconds);
    const std::string text = work().substr(0, 4000);
    if (write(ends[1], text.data(), text.size()) < 0) _exit(1);
    _exit(0);
  }
  close(ends[1]);
  ChildOutcome out;
  char buffer[4096];
  for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) > 0;) {
    out.text.append(buffer, size_t(n));
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  out.timed_out = WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM;
  out.crashed = !out.timed_out && (WIFSIGNALED(status) || WEXITSTATUS(status) != 0);
  return out;
}

}  // namespace tumble
