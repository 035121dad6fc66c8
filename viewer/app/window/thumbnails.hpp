#pragma once
#include "viewer/render/renderer.hpp"
#include "viewer/render/ui_draw_list.hpp"
#include "viewer/ui/ui_state.hpp"

#include <chrono>
#include <filesystem>
#include <map>
#include <set>
#include <string>

namespace tumble {

/// Thumbnails of scenes for the list. Each is rendered once by `tumble render` in a process of its
/// own, one at a time and only for visible entries, and cached for the user under the hash of the
/// scene's text. The window never waits for one.
class Thumbnails {
 public:
  static constexpr int width = 192, height = 108;  // [px]

  /// `program` is the path of tumble; empty: only existing thumbnails are shown.
  Thumbnails(std::filesystem::path folder, std::filesystem::path program)
      : folder_(std::move(folder)), program_(std::move(program)) {}
  ~Thumbnails();
  Thumbnails(const Thumbnails&) = delete;
  Thumbnails& operator=(const Thumbnails&) = delete;

  /// To be called when the list is opened: scenes whose files have changed get new thumbnails.
  void look_again(const std::vector<SceneItem>& scenes);
  /// To be called once per picture, with the visible scenes: loads one thumbnail, or starts
  /// rendering one.
  void update(const std::vector<SceneItem>& scenes, const std::vector<std::string>& seen,
              Renderer& renderer);
  const std::map<std::string, UiTextureId>& pictures() const { return pictures_; }
  bool busy() const { return process_ > 0; }
  size_t made() const { return made_; }

  /// $XDG_CACHE_HOME/tumble/thumbnails; empty if there is no home directory.
  static std::filesystem::path usual_folder();

 private:
  std::filesystem::path file_of(const SceneItem& item);
  bool load(const SceneItem& item, Renderer& renderer);
  void begin(const SceneItem& item);
  void look_after_process();
  void end_process(bool good);

  std::filesystem::path folder_, program_;
  std::map<std::string, UiTextureId> pictures_;
  std::map<std::string, std::filesystem::path> files_;  ///< by name of the scene
  std::set<std::string> failed_;
  int process_ = 0;
  std::string making_;          ///< the scene being rendered
  std::filesystem::path work_;  ///< temporary folder for it
  std::chrono::steady_clock::time_point since_;
  size_t made_ = 0;
};

}  // namespace tumble
