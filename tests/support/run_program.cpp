#include "tests/support/run_program.hpp"

#include "tests/support/process_limits.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tumble {
namespace {

[[noreturn]] void become(const std::filesystem::path& program,
                         const std::vector<std::string>& arguments, const ProgramOptions& options,
                         int out, int err) {
  ::setpgid(0, 0);
  if (!options.stdout_to.empty()) out = ::open(options.stdout_to.c_str(), O_WRONLY);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  for (const auto& [name, value] : options.environment)
    value.empty() ? ::unsetenv(name.c_str()) : ::setenv(name.c_str(), value.c_str(), 1);
  if (options.file_limit > 0) {
    const rlimit limit{options.file_limit, options.file_limit};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  if (options.cpu_seconds > 0 || options.megabytes > 0)
    limit_process(options.cpu_seconds, options.megabytes);
  std::vector<char*> argv;
  std::string name = program.string();
  argv.push_back(name.data());
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  ::execv(name.c_str(), argv.data());
  ::_exit(127);
}

/// Appends what there is to read; false at the end of the stream.
bool drain(int fd, std::string& text) {
  char block[1 << 14];
  const ssize_t n = ::read(fd, block, sizeof block);
  if (n > 0) text.append(block, size_t(n));
  return n > 0;
}

}  // namespace

ProgramRun run_program(const std::filesystem::path& program,
                       const std::vector<std::string>& arguments, const ProgramOptions& options) {
  ProgramRun run;
  int out[2], err[2];
  if (::pipe2(out, O_CLOEXEC) != 0 || ::pipe2(err, O_CLOEXEC) != 0) return run;
  const pid_t child = ::fork();
  if (child == 0) become(program, arguments, options, out[1], err[1]);
  ::close(out[1]);
  ::close(err[1]);

  const auto start = std::chrono::steady_clock::now();
  bool signalled = false, out_open = true, err_open = true;
  while (out_open || err_open) {
    pollfd fds[2] = {{out_open ? out[0] : -1, POLLIN, 0}, {err_open ? err[0] : -1, POLLIN, 0}};
    ::poll(fds, 2, 5);
    if (fds[0].revents) out_open = drain(out[0], run.out);
    if (fds[1].revents) err_open = drain(err[0], run.err);
    if (!signalled && options.signal_when)
      if (const int signal = options.signal_when()) {
        ::kill(child, signal);
        signalled = true;
      }
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    if (spent.count() > options.timeout) {
      run.err += "\n(killed after the time limit)";
      ::kill(-child, SIGKILL);
      break;
    }
  }
  ::close(out[0]);
  ::close(err[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return run;
}

}  // namespace tumble
