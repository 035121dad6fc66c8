#pragma once
#include <array>
#include <cstdio>
#include <functional>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

namespace tumble::test {

/// What `work` answers in a child process of its own, so that environment variables and broken
/// drivers stay there; "crashed" when it does not end well.
inline std::string in_child(const std::function<std::string()>& work) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return "no pipe";
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    const std::string answer = work();
    const bool good = write(ends[1], answer.data(), answer.size()) == ssize_t(answer.size());
    _exit(good ? 0 : 1);
  }
  close(ends[1]);
  std::string answer;
  std::array<char, 4096> chunk{};
  for (ssize_t n = 0; (n = read(ends[0], chunk.data(), chunk.size())) > 0;)
    answer.append(chunk.data(), size_t(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? answer : "crashed";
}

}  // namespace tumble::test
