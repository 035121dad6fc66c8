#pragma once
#include "viewer/render/renderer.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// Pictures that a person has asked for, with the panels or without, and those that were saved.
class Screenshots {
 public:
  explicit Screenshots(std::filesystem::path folder) : folder_(std::move(folder)) {}

  void want(bool with_panels) { (with_panels ? whole_ : plain_) = true; }
  bool wanted() const { return whole_ || plain_; }
  /// Whether one is wanted of the picture as it is drawn; asking takes the wish away.
  bool take(bool with_panels) { return std::exchange(with_panels ? whole_ : plain_, false); }
  bool wants_plain() const { return plain_; }
  /// Writes the renderer's last picture under a new name.
  Result<std::filesystem::path> save(Renderer& renderer, const std::string& scene);
  const std::vector<std::filesystem::path>& saved() const { return saved_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> saved_;
  bool whole_ = false, plain_ = false;
};

}  // namespace tumble
