#pragma once

namespace tumble {

/// With how many of its pixels the world is drawn (RenderScene::resolution), so that pictures
/// follow each other fluently: fewer when they have been slow for a while, more again as soon as
/// they would be fluent with more. Where fewer pixels do not make pictures shorter it goes back and
/// stays there, until they take clearly longer or have been fluent for long. The same times give
/// the same resolutions.
class ResolutionControl {
 public:
  /// From one picture to the next [s]; `period`: of the display, which no picture is shorter than;
  /// 0: not known.
  void see(double seconds, double period = 0);
  float resolution() const;

 private:
  void lower();
  bool lowered_in_vain(double seconds);
  void go_back();

  int step_ = 0;
  int slow_ = 0, quick_ = 0;   ///< pictures in a row
  double least_slow_ = 0;      ///< the shortest of those in a row [s]
  int since_raise_ = 1 << 20;  ///< pictures
  int wait_ = 0;               ///< quick pictures in a row until more pixels are tried
  int fluent_ = 0;             ///< pictures in a row

  int trial_ = 0;           ///< pictures until the last lowering is judged; 0: it is
  int from_ = 0;            ///< the step before it
  double before_ = 0;       ///< what pictures took before it, at least [s]
  double least_trial_ = 0;  ///< and since [s]
  double vain_ = 0;         ///< when pictures took this long, lowering was in vain; 0: unknown [s]
};

}  // namespace tumble
