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

/// Small pictures of scenes for the list. Each is made once by `tumble render` in a process of its
/// own, one at a time and only of scenes that are on the screen, and kept in the user's cache under
/// the hash of the scene's text: the window never waits for one.
class Thumbnails {
 public:
  static constexpr int width = 192, height = 108;  // [px]

  /// `program` is tumble itself; empty: only pictures that are there already are shown.
  Thumbnails(std::filesystem::path folder, std::filesystem::path program)
      : folder_(std::move(folder)), program_(std::move(program)) {}
  ~Thumbnails();
  Thumbnails(const Thumbnails&) = delete;
  Thumbnails& operator=(const Thumbnails&) = delete;

  /// Somebody looks at the list anew: scenes whose files have changed get other pictures.
  void look_again(const std::vector<SceneItem>& scenes);
  /// Once a picture, with the scenes that are on the screen: loads one picture, or begins one.
  void update(const std::vector<SceneItem>& scenes, const std::vector<std::string>& seen,
              Renderer& renderer);
  const std::map<std::string, UiTextureId>& pictures() const { return pictures_; }
  bool busy() const { return process_ > 0; }
  size_t made() const { return made_; }

  /// $XDG_CACHE_HOME/tumble/thumbnails; empty: there is no home.
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
  std::string making_;          ///< the scene whose picture is made
  std::filesystem::path work_;  ///< the folder that it is made in
  std::chrono::steady_clock::time_point since_;
  size_t made_ = 0;
};

}  // namespace tumble
