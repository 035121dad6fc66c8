#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace tumble {

/// Notices that somebody else has written a file, by looking at its time and size now and then.
class FileWatch {
 public:
  /// Watches this file from now on, `known` being what it holds; an empty path: nothing.
  void open(std::filesystem::path file, std::string known);
  /// Called once a picture. The new text, once, as soon as the file has been left alone for an
  /// instant (editors write in steps). Nothing while it cannot be read.
  std::optional<std::string> look(double dt);

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
  bool to_read_ = false;   ///< its stamp does not prove that it is as it was when it was last read
  double since_look_ = 0;  ///< [s]
};

}  // namespace tumble
