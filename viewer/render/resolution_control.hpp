#pragma once

namespace tumble {

/// Controls RenderScene::resolution so that pictures follow each other fluently: it lowers the
/// resolution when pictures have been slow for a while, and raises it when they would be fluent
/// with more pixels. If fewer pixels do not shorten the time per picture, it goes back to the
/// former resolution and stays there until pictures take clearly longer or have been fluent for
/// long. Deterministic: the same times give the same resolutions.
class ResolutionControl {
 public:
  /// Takes the time from one picture to the next [s]. `period` is that of the display, below which
  /// no such time can be; 0: not known.
  void see(double seconds, double period = 0);
  float resolution() const;

 private:
  void lower();
  bool lowered_in_vain(double seconds);
  void go_back();

  int step_ = 0;
  int slow_ = 0, quick_ = 0;   ///< slow and quick pictures in a row
  double least_slow_ = 0;      ///< the shortest time among the slow pictures in a row [s]
  int since_raise_ = 1 << 20;  ///< pictures since the resolution was raised
  int wait_ = 0;    ///< number of quick pictures in a row after which more pixels are tried
  int fluent_ = 0;  ///< fluent pictures in a row

  int trial_ = 0;           ///< pictures left until the last lowering is judged; 0: it has been
  int from_ = 0;            ///< the step of `scales` before that lowering
  double before_ = 0;       ///< least time per picture before it [s]
  double least_trial_ = 0;  ///< least time per picture since then [s]
  double vain_ = 0;         ///< time per picture at which lowering did not help; 0: unknown [s]
};

}  // namespace tumble
