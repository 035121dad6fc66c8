#include "engine/scene/mesh_files/limited_reader.hpp"

#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TUMBLE_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define TUMBLE_SANITIZED 1
#endif
#endif
#ifndef TUMBLE_SANITIZED
#define TUMBLE_SANITIZED 0
#endif

namespace tumble {
namespace {

/// The first byte that the child process sends.
enum class Answer : uint8_t { mesh, fault, no_memory };

// -- in the child ---------------------------------------------------------------------------------

/// Size of the address space of this process [bytes].
uint64_t address_space() {
  uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * uint64_t(::sysconf(_SC_PAGESIZE));
}

void limit(int what, uint64_t most, uint64_t grace = 0) {
  const rlimit value{most, most + grace};
  ::setrlimit(decltype(RLIMIT_CPU)(what), &value);
}

void send(int to, const void* data, size_t size) {
  const char* p = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = ::write(to, p, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) ::_exit(1);
    p += n;
    size -= size_t(n);
  }
}
template <class T>
void send_value(int to, const T& value) {
  send(to, &value, sizeof value);
}
template <class T>
void send_list(int to, const std::vector<T>& list) {
  send_value(to, uint64_t(list.size()));
  send(to, list.data(), list.size() * sizeof(T));
}
void send_text(int to, const std::string& text) {
  send_value(to, uint64_t(text.size()));
  send(to, text.data(), text.size());
}

void send_mesh(int to, const PolygonFile& m) {
  send_value(to, Answer::mesh);
  send_list(to, m.vertices);
  send_list(to, m.corners);
  send_list(to, m.polygon_first);
  send_value(to, uint64_t(m.dropped_polygons));
  send_value(to, uint64_t(m.parts.size()));
  for (const PolygonFile::Part& p : m.parts) {
    send_text(to, p.name);
    send_value(to, uint64_t(p.first_vertex));
    send_value(to, uint64_t(p.first_polygon));
  }
}

[[noreturn]] void work(int to, const std::filesystem::path& file,
                       Result<PolygonFile> (*read)(const std::filesystem::path&),
                       const ReadingLimits& limits) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The program's own signal handlers must not run in this process.
  for (const int s : {SIGINT, SIGTERM, SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGXCPU, SIGPIPE})
    std::signal(s, SIG_DFL);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, uint64_t(std::ceil(limits.seconds)), 1);
  limit(RLIMIT_AS, address_space() + limits.bytes);
  try {
    const Result<PolygonFile> mesh = read(file);
    if (mesh) {
      send_mesh(to, *mesh);
    } else {
      send_value(to, Answer::fault);
      send_value(to, mesh.error().code);
      send_text(to, mesh.error().message);
      send_text(to, mesh.error().cure);
    }
  } catch (const std::bad_alloc&) {
    send_value(to, Answer::no_memory);
  }
  ::_exit(0);
}

// -- in the parent --------------------------------------------------------------------------------

/// Receives what the child sends until a deadline; false at the end of the data or when time is up.
class Receiver {
 public:
  Receiver(int from, double seconds)
      : from_(from),
        end_(Clock::now() +
             std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds))) {}

  bool late() const { return late_; }

  bool take(void* data, size_t size) {
    char* p = static_cast<char*>(data);
    while (size > 0) {
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(end_ - Clock::now()).count();
      if (left <= 0) {
        late_ = true;
        return false;
      }
      pollfd fd{from_, POLLIN, 0};
      const int ready = ::poll(&fd, 1, int(left));
      if (ready <= 0) continue;
      const ssize_t n = ::read(from_, p, size);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      p += n;
      size -= size_t(n);
    }
    return true;
  }
  template <class T>
  bool value(T& v) {
    return take(&v, sizeof v);
  }
  template <class List>
  bool list(List& l, uint64_t most) {
    uint64_t n = 0;
    if (!value(n) || n > most) return false;
    l.resize(size_t(n));
    return take(l.data(), l.size() * sizeof(l[0]));
  }

 private:
  using Clock = std::chrono::steady_clock;
  int from_;
  Clock::time_point end_;
  bool late_ = false;
};

bool take_mesh(Receiver& in, PolygonFile& m) {
  constexpr uint64_t most = 5 * uint64_t(most_mesh_elements);
  uint64_t dropped = 0, parts = 0;
  if (!in.list(m.vertices, most) || !in.list(m.corners, most) || !in.list(m.polygon_first, most) ||
      !in.value(dropped) || !in.value(parts) || parts > most)
    return false;
  m.dropped_polygons = size_t(dropped);
  for (uint64_t i = 0; i < parts; ++i) {
    PolygonFile::Part p;
    uint64_t vertex = 0, polygon = 0;
    if (!in.list(p.name, most) || !in.value(vertex) || !in.value(polygon)) return false;
    p.first_vertex = size_t(vertex);
    p.first_polygon = size_t(polygon);
    m.parts.push_back(std::move(p));
  }
  return true;
}

/// The error for a child process that sent no complete answer.
Error silence(const std::filesystem::path& file, int status, bool late,
              const ReadingLimits& limits) {
  constexpr const char* cure = "the file is damaged, or not of the type that its name says";
  const bool signalled = WIFSIGNALED(status);
  std::string why = "its reader ended without an answer";
  if (late || (signalled && WTERMSIG(status) == SIGXCPU))
    why = fmt::format("reading it takes more than {:.0f} s", limits.seconds);
  else if (signalled && (WTERMSIG(status) == SIGINT || WTERMSIG(status) == SIGTERM))
    why = "reading it was interrupted";
  else if (signalled)
    why = fmt::format("its reader crashed: {}", ::strsignal(WTERMSIG(status)));
  return {ErrorCode::parse, why, file.string(), cure};
}

}  // namespace

ReadingLimits reading_limits(uint64_t file_bytes) {
  constexpr uint64_t mebibyte = uint64_t{1} << 20;
  return {10 + double(file_bytes / mebibyte), 1024 * mebibyte + 64 * file_bytes};
}

bool reads_in_a_process_of_its_own() {
  return TUMBLE_SANITIZED == 0;
}

Result<PolygonFile> read_limited(const std::filesystem::path& file,
                                 Result<PolygonFile> (*read)(const std::filesystem::path&),
                                 const ReadingLimits& limits) {
  if constexpr (TUMBLE_SANITIZED) return read(file);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    return Error{ErrorCode::io,
                 std::string("no pipe for its reader: ") + std::strerror(errno),
                 file.string(),
                 {}};
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    work(ends[1], file, read, limits);
  }
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    return Error{ErrorCode::io,
                 std::string("no process for its reader: ") + std::strerror(errno),
                 file.string(),
                 {}};
  }
  Receiver in(ends[0], 3 * limits.seconds);
  Answer answer{};
  PolygonFile mesh;
  Error fault{ErrorCode::parse, {}, file.string(), {}};
  bool whole = in.value(answer);
  if (whole && answer == Answer::mesh) whole = take_mesh(in, mesh);
  if (whole && answer == Answer::fault)
    whole = in.value(fault.code) && in.list(fault.message, 1 << 20) && in.list(fault.cure, 1 << 20);
  ::close(ends[0]);
  if (!whole) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!whole) return silence(file, status, in.late(), limits);
  if (answer == Answer::no_memory)
    return mesh_file_fault(file,
                           fmt::format("reading it takes more than {} MiB of memory: the file "
                                       "is damaged, or declares more than it holds",
                                       limits.bytes >> 20));
  if (answer == Answer::fault) return fault;
  return mesh;
}

}  // namespace tumble
