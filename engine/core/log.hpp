#pragma once
#include <memory>
#include <string_view>
#include <type_traits>
#include <utility>

namespace tumble {

enum class LogLevel { debug, info, warning, error };

/// Receives the messages of one World or one loader; provided by its owner, never global. Holds a
/// callable f(level, message), shared by copies; an empty sink converts to false and must not be
/// called. (A std::function would add 10,000 lines to world.hpp.)
class LogSink {
 public:
  LogSink() = default;
  template <class F>
  requires std::is_invocable_v<const F&, LogLevel, std::string_view> LogSink(F receive)
      : receiver_(std::make_shared<const Holder<F>>(std::move(receive))) {}

  explicit operator bool() const { return receiver_ != nullptr; }
  void operator()(LogLevel level, std::string_view message) const {
    receiver_->receive(level, message);
  }

 private:
  struct Receiver {
    virtual ~Receiver() = default;
    virtual void receive(LogLevel level, std::string_view message) const = 0;
  };
  template <class F>
  struct Holder final : Receiver {
    explicit Holder(F f) : call(std::move(f)) {}
    void receive(LogLevel level, std::string_view message) const override { call(level, message); }
    F call;
  };

  std::shared_ptr<const Receiver> receiver_;
};

/// Writes "tumble: warning: ..." lines to stderr, from `least` upwards.
LogSink stderr_log(LogLevel least = LogLevel::info);

}  // namespace tumble
