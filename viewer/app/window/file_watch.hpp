#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace tumble {

/// Detects that another program has written a file, by polling its time and size.
class FileWatch {
 public:
  /// Watches this file from now on; `known` is its present content. An empty path: watches nothing.
  void open(std::filesystem::path file, std::string known);
  /// To be called once per picture. Returns the new text, once, when the file has not changed for a
  /// moment (editors write in several steps). Empty while it cannot be read.
  std::optional<std::string> look(double dt);
  /// Whether the file has disappeared; once each time (editors remove it for a moment).
  bool take_gone() { return std::exchange(gone_, false); }

 private:
  struct Stamp {
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    friend bool operator==(const Stamp&, const Stamp&) = default;
  };
  std::optional<Stamp> stamp() const;

  std::filesystem::path file_;
  std::string known_;
  std::optional<Stamp> seen_;
  bool gone_ = false;  ///< not reported yet
  int missed_ = 0;     ///< consecutive polls that did not find it
  /// Its time stamp does not prove that it is unchanged since it was last read.
  bool to_read_ = false;
  double since_look_ = 0;  ///< time since the last poll [s]
};

}  // namespace tumble
