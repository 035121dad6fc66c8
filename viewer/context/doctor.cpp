#include "viewer/context/doctor.hpp"

#include "viewer/context/backends.hpp"
#include "viewer/context/probe.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tumble {
namespace {

constexpr unsigned longest_probe_seconds = 20;

// Entries are sent through the pipe as their strings, each terminated by a zero byte.
std::string pack(const DoctorEntry& e) {
  std::string out;
  for (const std::string& s : {std::string(e.ok ? "1" : "0"), e.detail, e.renderer, e.version,
                               std::string(e.software ? "1" : "0"), e.cause, e.cure}) {
    out += s;
    out += '\0';
  }
  return out;
}

bool unpack(const std::string& bytes, DoctorEntry& e) {
  std::array<std::string, 7> parts;
  size_t at = 0;
  for (std::string& part : parts) {
    const size_t end = bytes.find('\0', at);
    if (end == std::string::npos) return false;
    part = bytes.substr(at, end - at);
    at = end + 1;
  }
  e.ok = parts[0] == "1";
  e.detail = parts[1];
  e.renderer = parts[2];
  e.version = parts[3];
  e.software = parts[4] == "1";
  e.cause = parts[5];
  e.cure = parts[6];
  return true;
}

void write_all(int file, const std::string& bytes) {
  for (size_t at = 0; at < bytes.size();) {
    const ssize_t n = write(file, bytes.data() + at, bytes.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    at += size_t(n);
  }
}

std::string read_all(int file) {
  std::string bytes;
  std::array<char, 4096> chunk{};
  for (;;) {
    const ssize_t n = read(file, chunk.data(), chunk.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return bytes;
    bytes.append(chunk.data(), size_t(n));
  }
}

std::string how_it_ended(int status) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
    return fmt::format("the driver gave no answer within {} s", longest_probe_seconds);
  if (WIFSIGNALED(status))
    return fmt::format("the driver crashed with signal {} ({})", WTERMSIG(status),
                       strsignal(WTERMSIG(status)));
  return fmt::format("the driver ended the program with code {}", WEXITSTATUS(status));
}

DoctorEntry examine(const std::string& name) {
  DoctorEntry entry;
  entry.name = name;
  entry.cure = "update the driver, or use another --context";
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) {
    entry.cause = fmt::format("no pipe: {}", std::strerror(errno));
    return entry;
  }
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) {
    close(ends[0]);
    close(ends[1]);
    entry.cause = fmt::format("no child process: {}", std::strerror(errno));
    return entry;
  }
  if (child == 0) {
    close(ends[0]);
    alarm(longest_probe_seconds);
    write_all(ends[1], pack(probe_context(name)));
    _exit(0);  // without exit handlers, since those of drivers may hang or crash
  }
  close(ends[1]);
  const std::string bytes = read_all(ends[0]);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!unpack(bytes, entry)) entry.cause = how_it_ended(status);
  return entry;
}

/// Number of EGL devices, queried in a child process too; 0 if that fails.
size_t count_egl_devices(Error& error) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return 0;
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    alarm(longest_probe_seconds);
    const auto devices = egl_devices();
    DoctorEntry e;
    e.ok = devices.ok();
    if (devices) {
      e.detail = std::to_string(devices->size());
    } else {
      e.cause = (devices.error().place.empty() ? "" : devices.error().place + ": ") +
                devices.error().message;
      e.cure = devices.error().cure;
    }
    write_all(ends[1], pack(e));
    _exit(0);
  }
  close(ends[1]);
  const std::string bytes = child > 0 ? read_all(ends[0]) : "";
  close(ends[0]);
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  DoctorEntry e;
  if (!unpack(bytes, e)) {
    e.cause = how_it_ended(status);
    e.cure = "update the driver";
  }
  if (e.ok) return size_t(std::stoul(e.detail));
  error = {ErrorCode::unsupported, e.cause, "egl", e.cure};
  return 0;
}

}  // namespace

std::vector<DoctorEntry> run_doctor() {
  std::vector<DoctorEntry> entries = {examine("window")};
  Error no_devices;
  const size_t devices = count_egl_devices(no_devices);
  for (size_t i = 0; i < devices; ++i) entries.push_back(examine(fmt::format("egl:{}", i)));
  if (devices == 0) {
    DoctorEntry e;
    e.name = "egl";
    e.cause = no_devices.message;
    e.cure = no_devices.cure;
    entries.push_back(e);
  }
  entries.push_back(examine("surfaceless"));
  entries.push_back(examine("osmesa"));
  return entries;
}

std::string doctor_text(const std::vector<DoctorEntry>& entries) {
  std::string out;
  for (const DoctorEntry& e : entries) {
    const std::string name = e.detail.empty() ? e.name : e.name + " (" + e.detail + ")";
    if (e.ok)
      out += fmt::format("ok      {}: {}, OpenGL {}{}\n", name, e.renderer, e.version,
                         e.software ? ", drawn by the processor" : "");
    else
      out += fmt::format("failed  {}: {}\n        cure: {}\n", name, e.cause, e.cure);
  }
  return out;
}

}  // namespace tumble
