#pragma once
#include "viewer/render/render_scene.hpp"

#include <cstddef>
#include <thread>
#include <vector>

namespace tumble {

/// Memory that a software renderer is about to ask for (posix_memalign). The system makes its pages
/// in a thread of their own while driver and scene are loaded: writing to them for the first time
/// takes as long as either. There is one of these at a time.
class BlocksAhead {
 public:
  explicit BlocksAhead(std::vector<size_t> sizes);
  ~BlocksAhead();  ///< frees what nothing has asked for
  BlocksAhead(const BlocksAhead&) = delete;
  BlocksAhead& operator=(const BlocksAhead&) = delete;

 private:
  std::thread maker_;
};

/// The largest blocks of a first picture of this size, largest first [byte].
std::vector<size_t> blocks_of_picture(int width, int height, Quality quality);

}  // namespace tumble
