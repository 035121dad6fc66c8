#pragma once

namespace tumble {

/// With how many of its pixels the world is drawn (RenderScene::resolution), so that pictures
/// follow each other fluently: fewer when they have been slow for a while, more again as soon as
/// they would be fluent with more. The same times give the same resolutions.
class ResolutionControl {
 public:
  /// From one picture to the next [s].
  void see(double seconds);
  float resolution() const;

 private:
  void lower();

  int step_ = 0;
  int slow_ = 0, quick_ = 0;   ///< pictures in a row
  double least_slow_ = 0;      ///< the shortest of those in a row [s]
  int since_raise_ = 1 << 20;  ///< pictures
  int wait_ = 0;               ///< quick pictures in a row until more pixels are tried
};

}  // namespace tumble
