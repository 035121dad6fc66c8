#pragma once
#include "viewer/render/renderer.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// Screenshots requested by the user, with or without the panels, and the files saved.
class Screenshots {
 public:
  explicit Screenshots(std::filesystem::path folder) : folder_(std::move(folder)) {}

  void want(bool with_panels) { (with_panels ? whole_ : plain_) = true; }
  bool wanted() const { return whole_ || plain_; }
  /// Whether a screenshot of this kind is requested; resets the request.
  bool take(bool with_panels) { return std::exchange(with_panels ? whole_ : plain_, false); }
  bool wants_plain() const { return plain_; }
  /// Writes the renderer's last picture to a file with an unused name.
  Result<std::filesystem::path> save(Renderer& renderer, const std::string& scene);
  const std::vector<std::filesystem::path>& saved() const { return saved_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> saved_;
  bool whole_ = false, plain_ = false;
};

}  // namespace tumble
