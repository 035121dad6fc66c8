#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace tumble {

/// Notices that somebody else has written a file, by looking at its time and size now and then.
class FileWatch {
 public:
  /// Watches this file from now on, `known` being what it holds; an empty path: nothing.
  void open(std::filesystem::path file, std::string known);
  /// Called once a picture. The new text, once, as soon as the file has been left alone for an
  /// instant (editors write in steps). Nothing while it cannot be read.
  std::optional<std::string> look(double dt);
  /// The file is there no longer, once each time (editors take it away for an instant).
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
  bool gone_ = false;      ///< and nobody has been told yet
  int missed_ = 0;         ///< so many looks in a row have not found it
  bool to_read_ = false;   ///< its stamp does not prove that it is as it was when it was last read
  double since_look_ = 0;  ///< [s]
};

}  // namespace tumble
